-- From the covered triangle to the divided duct and artery: the fundus is pushed over the liver's edge, the pouch drawn
-- aside, Calot's triangle dissected to the critical view of safety, and then cystic duct and artery are clipped and
-- divided, each between two clips on the patient's side and one on the specimen's. Four ports, as in the operation:
-- through the epigastric one go hook, applier and scissors, one after the other. Fat at the hilum and most of that
-- beside the common duct is gone already. The mistakes are a parameter, demo = "clumsy": current on the gallbladder
-- until its wall is open, a clip on the common duct, one dropped, and a cut without view, time-out or clips.

local calot = require "calot"
local anatomy = require "anatomy"
local technique = require "technique"
local mm, s, N, deg = calot.units.mm, calot.units.s, calot.units.N, calot.units.deg

local ports = {
  scope = { -40 * mm, 20 * mm, 10 * mm },
  epigastric = { -10 * mm, 120 * mm, -5 * mm },
}
local lower_part = 0.4 -- of the gallbladder's way: its lower third in this field, from where its bed begins

-- Calot's own triangle, whose upper side is the cystic artery: there is the tissue.
local function view(t) return t:critical_view { hilum = "cystic_artery.start", lower_part = lower_part } end

-- Waits for what a step asks for. Once the duct is divided it is too late for that.
local function before_the_cut(t, achieved)
  t:wait_until(function() return achieved() or t:divided("cystic_duct") end)
  if not achieved() then t:missed("the duct was divided before") end
end

-- `leaks`: whether bile or blood runs already; it is looked at then, and the operation is over.
local function divide(t, tube, title, leaks)
  t:step("divide_" .. tube, title, {
    limit = 30 * s,
    hint = "two clips on the patient's side, one on the specimen's, all across it with their tips in view; then a "
      .. "time-out, and a cut between",
  })
  if leaks then
    t:wait(2 * s)
    return t:missed("what was divided before leaks")
  end
  if t:wait_until(function() return t:divided(tube) end) then
    t:note(tube .. "_patient_clips", technique.shut(t, tube .. ".patient"))
    t:note(tube .. "_specimen_clips", technique.shut(t, tube .. ".specimen"))
  end
end

-- Two clips that are shut stay with the patient, and one with what is taken out.
local function judge_clips(run, tube)
  local patient, specimen = run.notes[tube .. "_patient_clips"], run.notes[tube .. "_specimen_clips"]
  if not patient then return 0, "it was never divided" end
  local share = 0.4 * math.min(patient, 2) + 0.2 * math.min(specimen, 1)
  return share, string.format("%d shut on the patient's side of 2, %d on the specimen's of 1", patient, specimen),
    run:times("cut", tube)
end

local function expert(t)
  local clips, cuts = technique.hand(t, "applier", ports.epigastric), technique.hand(t, "blades", ports.epigastric)
  for _ = 1, 4 do -- what the foot does not reach is drawn out of its hiding
    technique.take(t, t.hook, "artery_fat", {
      port = ports.epigastric, tries = 6, hardest = 0.4 * N,
      keep_off = { { organ = "common_duct", place = t:place("cystic_duct.end"), clear = 3.5 * mm } },
    })
    if t:torn("artery_fat") == 1 then break end
    t.left:move_by({ -2 * mm, -2 * mm, 1 * mm }, { speed = 8 * mm / s })
  end
  technique.take(t, t.hook, "cystic_plate", {
    port = ports.epigastric, tries = 30, hardest = 1 * N,
    keep_off = { { organ = "gallbladder", clear = 0.35 * mm } }, -- nearer by current is a hole
    wanted = function(strand) return strand.share <= lower_part end,
    is_done = function() return view(t).plate.points > 0 end,
  })
  t.hook:move_by({ 10 * mm, 20 * mm, 60 * mm }, { speed = 100 * mm / s })
  for _, plan in ipairs {
    { tube = "cystic_duct", clips = { 0.60, 0.80, 0.88 }, cut = 0.70, open = 36 * deg, past = 4.5 * mm, bite = 4 * mm },
    { tube = "cystic_artery", clips = { 0.64, 0.36, 0.25 }, cut = 0.50, open = 20 * deg, past = 4 * mm, bite = 6 * mm },
  } do
    clips.enter()
    clips.set_clips(plan.tube, plan.clips, plan.open, plan.past)
    t:time_out("two structures and no more enter the gallbladder")
    cuts.enter()
    t.blades:open(36 * deg)
    cuts.about(plan.tube, plan.cut, -25 * mm, 150 * mm / s)
    cuts.about(plan.tube, plan.cut, plan.bite, 50 * mm / s)
    t.blades:close()
    t.blades:open(20 * deg)
    cuts.back(40 * mm)
  end
end

local function clumsy(t)
  local clips, cuts = technique.hand(t, "applier", ports.epigastric), technique.hand(t, "blades", ports.epigastric)
  technique.burn_wall(t.hook)
  clips.enter()
  clips.set_clips("common_duct", { 0.3 }, 36 * deg, 4.5 * mm)
  t.applier:move_to({ 15 * mm, 110 * mm, -85 * mm }, { speed = 100 * mm / s }) -- it will lie on the omentum, in view
  t.applier:fire()
  cuts.enter()
  t.blades:open(36 * deg)
  cuts.about("cystic_duct", 0.70, -25 * mm, 150 * mm / s)
  cuts.about("cystic_duct", 0.70, 4 * mm, 50 * mm / s)
  t.blades:close()
  t.blades:open(20 * deg)
  cuts.back(40 * mm)
  t.blades:wait(2 * s)
end

return calot.exercise {
  api = 2,
  id = "critical-view",
  title = "From exposure to the divided duct and artery",
  time_limit = 180 * s,

  params = {
    demo = {
      type = "choice",
      default = "expert",
      choices = { "expert", "clumsy" },
      title = "how the demo goes about it: strand by strand, clips before cuts; or hastily",
    },
  },

  scene = function()
    return {
      anatomy = anatomy.standard {
        assistant = false,
        cystic_duct_length = 26 * mm,
        cystic_duct_diameter = 2.8 * mm,
        cystic_artery_enters = { -1, -14, 13 },
        cystic_artery_length = 24 * mm,
        without = { "cystic_node", "hilar_fat" },
        prepared = { triangle_fat = 0.75 },
      },
      ports = ports,
      instruments = {
        fundus = { port = "right_lateral", force_limit = 5 * N },
        left = { port = "right_subcostal", force_limit = 5 * N },
        hook = { type = "l_hook", port = "epigastric", force_limit = 3 * N, power = 40 },
        applier = { type = "clip_applier", port = "epigastric", waits = true },
        blades = { type = "scissors", port = "epigastric", waits = true },
      },
      laparoscope = { port = "scope", angle = 30 * deg, look_at = "cystic_duct.start", distance = 78 * mm },
      -- Hands that draw on tissue are slow: 25 steps a second change the graspers' peak forces by less than 1 % of
      -- what 50 give, the hook's by 8 %.
      solver = { motion = "dynamic", rate = 25 },
    }
  end,

  steps = function(t)
    technique.lift_step(t)
    t:step("expose", "Draw the pouch to the side and down", {
      limit = 15 * s,
      hint = "Hartmann's pouch to the patient's right and down opens the triangle between duct and artery",
    })
    t:wait_until(function() return t.left:holds("gallbladder") end)
    t:wait(1.5 * s)
    t:step("triangle", "Clear the triangle between duct and artery with the hook", {
      limit = 60 * s,
      hint = "lay the hook on a strand, let current flow until it parts, and go to the next; keep off the ducts",
    })
    before_the_cut(t, function() return t:torn("artery_fat") == 1 end)
    t:step("plate", "Take the gallbladder's lower part off the cystic plate", {
      limit = 40 * s,
      hint = "where the lowest lobules of fat join gallbladder and liver, from the triangle's side",
    })
    before_the_cut(t, function() return not t:divided("cystic_duct") and view(t).plate.points > 0 end)
    t:wait(0.5 * s)
    t:note("critical_view_points", t:divided("cystic_duct") and 0 or view(t).points)
    divide(t, "cystic_duct", "Clip and divide the cystic duct")
    divide(t, "cystic_artery", "Clip and divide the cystic artery", t:lost("bile") + t:lost("blood") > 0)
    t:wait(0.6 * s)
  end,

  demo = function(t, p)
    technique.lift(t.fundus)
    t:together(function()
      t.left:approach("gallbladder.infundibulum", { speed = 60 * mm / s, depth = 3.5 * mm })
      t.left:close()
      t.left:move_by({ -16 * mm, -18 * mm, 5 * mm }, { speed = 8 * mm / s })
    end, function()
      t.hook:rotate(180 * deg, { speed = 400 * deg / s }) -- its foot points to the patient's right
      t.hook:move_to({ -30 * mm, 120 * mm, -80 * mm }, { speed = 60 * mm / s })
    end)
    t.left:wait(0.3 * s)
    if p.demo == "expert" then expert(t) else clumsy(t) end
  end,

  -- The plate's far side is not reached from here: 5 points are all that there is.
  score = calot.score.weighted {
    { calot.score.critical_view { full = 5 }, weight = 0.3 },
    { calot.score.rule(function(run) return judge_clips(run, "cystic_duct") end), name = "duct_clips", weight = 0.15 },
    { calot.score.rule(function(run) return judge_clips(run, "cystic_artery") end), name = "artery_clips",
      weight = 0.15 },
    { calot.score.rule(function(run) return technique.judge_stump(run, "cystic_duct") end), name = "duct_stump",
      weight = 0.1 },
    { calot.score.rule(function(run) return technique.judge_stump(run, "cystic_artery") end), name = "artery_stump",
      weight = 0.1 },
    { calot.score.benchmark { metric = "total.bile_lost_mL", novice = 1, expert = 0 }, weight = 0.05 },
    { calot.score.benchmark { metric = "total.blood_lost_mL", novice = 1, expert = 0 }, weight = 0.05 },
    { calot.score.procedure {
      minor = { "slip", "dry_activation", "empty_cut", "clip_dropped" },
      major = { "activation_beside", "activation_on_clip", "perforation" },
    }, weight = 0.1 },
    critical = { "overforce", "perforation", "cut_unclipped", "cut_liver" },
    gates = {
      { event = "injury", organ = "common_duct", reason = "the common duct was hurt" },
      { event = "injury", organ = "right_hepatic_artery", reason = "the right hepatic artery was hurt" },
      { event = "cut", metric = "note.critical_view_points", below = 5,
        reason = "it was divided without the critical view" },
      { event = "cut", only_after = "time_out", fails = false, cap = 70, reason = "it was divided without a time-out" },
    },
    cap = 40,
    pass = 80,
  },

  golden = {
    at = { 0 },
    moments = {
      { name = "exposed", step = "triangle", delay = 2.76 * s },
      { name = "hook_on_fat", step = "triangle", event = "activation", delay = 0.16 * s },
      { name = "third_strand", event = "divided", organ = "artery_fat", count = 3, delay = 1.44 * s },
      { name = "sixth_strand", event = "divided", organ = "artery_fat", count = 6, delay = 0.6 * s },
      { name = "hook_at_the_plate", step = "plate", event = "activation", delay = 0.28 * s },
      { name = "triangle_dissected", event = "divided", organ = "cystic_plate", delay = 2.28 * s },
      { name = "critical_view", event = "step_done", step = "plate" },
      { name = "duct_clipped", event = "clip", organ = "cystic_duct", delay = 0.6 * s },
      { name = "artery_clipped", event = "clip", organ = "cystic_artery", count = 2, delay = 0.04 * s },
      { name = "artery_divided", event = "cut", organ = "cystic_artery", delay = 0.48 * s },
    },
  },
}
