-- The cystic duct, or the cystic artery, is clipped and divided: two clips on the patient's side, one on the
-- specimen's, and a cut between them. Calot's triangle has been cleared of its tissue before; for the artery the duct
-- has been divided and drawn aside. The mistake that ends in bile or blood is a parameter, demo = "clumsy": it cuts
-- before it clips, and then drops a clip.

local calot = require "calot"
local anatomy = require "anatomy"
local technique = require "technique"
local mm, s, deg = calot.units.mm, calot.units.s, calot.units.deg

local ports = { applier = { -10 * mm, 120 * mm, -5 * mm }, blades = { 0, 0, 0 } }

return calot.exercise {
  api = 2,
  id = "clip-and-divide",
  title = "Clip and divide the cystic duct",
  time_limit = 60 * s,

  params = {
    structure = {
      type = "choice",
      default = "cystic_duct",
      choices = { "cystic_duct", "cystic_artery" },
      title = "what is clipped and divided",
    },
    demo = {
      type = "choice",
      default = "expert",
      choices = { "expert", "clumsy" },
      title = "how the demo goes about it: clips first, as an expert, or cuts first",
    },
  },

  scene = function(p)
    local without = { "triangle_fat", "artery_fat", "hilar_fat", "cystic_node" }
    if p.structure == "cystic_artery" then without = { "cystic_duct", "hilar_fat", "cystic_node" } end
    return {
      anatomy = anatomy.standard {
        cystic_duct_length = 26 * mm,
        cystic_duct_diameter = 2.8 * mm,
        without = without,
      },
      ports = { scope = { -40 * mm, 20 * mm, 10 * mm } },
      instruments = {
        applier = { type = "clip_applier", port = "epigastric" },
        blades = { type = "scissors", port = "umbilical" },
      },
      laparoscope = { port = "scope", angle = 0, look_at = p.structure .. ".middle", distance = 95 * mm },
      solver = { motion = "dynamic" },
    }
  end,

  steps = function(t, p)
    t:step("clip", "Set two clips on the patient's side and one on the specimen's", {
      limit = 30 * s,
      hint = "each all across it, with the tips of its legs in view beyond, and room to cut between",
    })
    t:wait_until(function() return t:divided(p.structure) or #t:clips(p.structure) == 3 end)
    if t:divided(p.structure) then t:missed("it was divided before") end
    t:step("divide", "Divide it between the clips", {
      limit = 30 * s,
      hint = "first a time-out: say what is about to be divided, and what was seen of it",
    })
    if t:wait_until(function() return t:divided(p.structure) end) then
      t:note("patient_clips", technique.shut(t, p.structure .. ".patient"))
      t:note("specimen_clips", technique.shut(t, p.structure .. ".specimen"))
    end
    t:wait(0.6 * s)
    if t:lost("bile") + t:lost("blood") > 0 then t:wait(1.4 * s) end -- what runs is looked at
  end,

  demo = function(t, p)
    local clips, cuts = technique.hand(t, "applier", ports.applier), technique.hand(t, "blades", ports.blades)
    local plan = {
      cystic_duct = { clips = { 0.60, 0.80, 0.88 }, cut = 0.70, reach = 6 * mm, open = 36 * deg, past = 4.5 * mm },
      cystic_artery = { clips = { 0.64, 0.36, 0.25 }, cut = 0.50, reach = 4 * mm, open = 20 * deg, past = 4 * mm },
    }
    local tube, plan_of = p.structure, plan[p.structure]
    t:together(function()
      t.blades:open(36 * deg)
      cuts.about(tube, plan_of.cut, -25 * mm, 150 * mm / s)
    end, function()
      if p.demo == "expert" then clips.set_clips(tube, plan_of.clips, plan_of.open, plan_of.past) end
    end)
    if p.demo == "expert" then t:time_out("two structures and no more enter the gallbladder") end
    cuts.about(tube, plan_of.cut, plan_of.reach, 50 * mm / s)
    t.blades:close()
    if p.demo == "clumsy" then t.applier:fire() end
    t.blades:open(20 * deg)
    cuts.back(25 * mm)
  end,

  score = calot.score.weighted {
    { calot.score.benchmark { metric = "note.patient_clips", novice = 0, expert = 2 }, weight = 0.4 },
    { calot.score.benchmark { metric = "note.specimen_clips", novice = 0, expert = 1 }, weight = 0.1 },
    { calot.score.rule(function(run) return technique.judge_stump(run, run.params.structure) end), name = "stump",
      weight = 0.1 },
    { calot.score.benchmark { metric = "total.bile_lost_mL", novice = 1, expert = 0 }, weight = 0.1 },
    { calot.score.benchmark { metric = "total.blood_lost_mL", novice = 1, expert = 0 }, weight = 0.1 },
    { calot.score.penalty { event = "clip_dropped", each = 0.5 }, weight = 0.1 },
    { calot.score.penalty { event = "empty_cut", each = 0.5 }, weight = 0.1 },
    critical = { "cut_unclipped", "perforation", "cut_liver" },
    gates = {
      { event = "injury", organ = "common_duct", reason = "the common duct was hurt" },
      { event = "injury", organ = "right_hepatic_artery", reason = "the right hepatic artery was hurt" },
      { event = "cut", only_after = "time_out", fails = false, cap = 70, reason = "it was divided without a time-out" },
    },
    cap = 40,
    pass = 80,
  },

  golden = { at = { 4.9 * s, 6.2 * s } },
}
