-- Calot's triangle is dissected to the critical view of safety: the tissue between cystic duct and cystic artery is
-- taken with the hook until the liver is seen behind them, and the gallbladder's lower part comes off the cystic plate,
-- so that two structures and no more are seen to enter the gallbladder. With flip = true the pouch is turned over then,
-- and what is left of the lower part comes off from the patient's right: all six points of the view. The field is
-- prepared: fat at the hilum and most of that beside the common duct is gone. The mistakes are a parameter, demo =
-- "clumsy": current in the air, and an end before the view is there. In field = "frozen" the tissue is a scar that
-- current and traction hardly divide: the view cannot be reached there, and who tries on fails; who bails out (demo =
-- "bail_out") after tissue that does not yield passes.

local calot = require "calot"
local anatomy = require "anatomy"
local technique = require "technique"
local mm, s, N, deg = calot.units.mm, calot.units.s, calot.units.N, calot.units.deg

local hook_port, side_port = { -10 * mm, 120 * mm, -5 * mm }, { -140 * mm, 10 * mm, 0 } -- epigastric, right_lateral
local lower_part = 0.4 -- of the gallbladder's way: its lower third in this field, from where its bed begins

-- Calot's own triangle, whose upper side is the cystic artery: there is the tissue.
local function view(t) return t:critical_view { hilum = "cystic_artery.start", lower_part = lower_part } end

local function note(t, when)
  local now = view(t)
  t:note("critical_view" .. when, now.points)
  t:note("front_pct" .. when, 100 * now.triangle.front, "%")
  t:note("behind_pct" .. when, 100 * now.triangle.behind, "%")
  t:note("plate_pct" .. when, 100 * now.plate.share, "%")
  t:note("free_structures" .. when, now.structures.free)
end

-- Bailing out is right where the tissue does not yield: current divides little of what it flows through.
local function judge_bail_out(run)
  local area, time = run.metrics["hook.divided_mm2"], run.metrics["hook.activation_time_s"]
  local right = time >= 2 * s and area <= 2 * time
  local felt = string.format("%.1f s of current divided %.1f mm2", time, area)
  return right, felt .. (right and ": it does not yield" or ": it yields, or was not tried"), run:times("bail_out")
end

-- The view, or the way out where it cannot be had. Five points of six satisfy who does not turn the pouch over.
local function judge_view(run)
  if run:count("bail_out") > 0 then
    local right, felt, away = judge_bail_out(run)
    return right and 1 or 0, felt, away
  end
  local points, wanted = run.notes.critical_view or 0, run.params.flip and 6 or 5
  return math.min(1, points / wanted), string.format("%d of 6 points, of which %d are asked for", points, wanted)
end

-- The left hand swings the pouch over to the patient's left and up, until the plate's right side is under tension.
local function turn_over(t)
  t:together(function()
    t.left:move_by({ 34 * mm, 12 * mm, 20 * mm }, { speed = 20 * mm / s })
  end, function()
    t.laparoscope:look_at("gallbladder.infundibulum", { distance = 75 * mm })
  end)
  t.left:move_until(function() return t.left:force("jaws") > 3.6 * N end,
    { along = { 0.6, 0.4, 0.6 }, speed = 15 * mm / s, limit = 15 * mm })
end

return calot.exercise {
  api = 2,
  id = "dissect-to-critical-view",
  title = "Dissect to the critical view of safety",
  time_limit = 220 * s,

  params = {
    demo = {
      type = "choice",
      default = "expert",
      choices = { "expert", "clumsy", "bail_out" },
      title = "how the demo goes about it: strand by strand with the hook, hastily, or until the tissue does not yield",
    },
    field = {
      type = "choice",
      default = "standard",
      choices = { "standard", "frozen" },
      title = "the patient's triangle: fat, or the scar of many inflammations",
    },
    flip = {
      type = "boolean",
      default = false,
      title = "whether the pouch is turned over as well, and the plate's right side taken: all six points",
    },
  },

  scene = function(p)
    return {
      anatomy = anatomy.standard {
        strength = p.field == "frozen" and 25 or 1,
        cystic_artery_enters = { -1, -14, 13 },
        cystic_artery_length = 24 * mm,
        without = { "cystic_node", "hilar_fat" },
        prepared = { triangle_fat = 0.75 },
      },
      ports = { scope = p.flip and { -110 * mm, 20 * mm, 10 * mm } or { -40 * mm, 20 * mm, 10 * mm } },
      instruments = {
        left = { port = "right_subcostal", force_limit = 5 * N },
        hook = { type = "l_hook", port = "epigastric", force_limit = 3 * N, power = 40 },
        side_hook = p.flip and { type = "l_hook", port = "right_lateral", force_limit = 3 * N, power = 40 } or nil,
      },
      laparoscope = { port = "scope", angle = 30 * deg, look_at = "cystic_duct.middle", distance = 75 * mm },
      solver = { motion = "dynamic", rate = 25 }, -- as critical_view.lua
    }
  end,

  steps = function(t, p)
    t:step("expose", "Draw the pouch to the side and down", {
      limit = 15 * s,
      hint = "Hartmann's pouch to the patient's right and down opens the triangle between duct and artery",
    })
    t:wait_until(function() return t.left:holds("gallbladder") end)
    t:wait(1.5 * s)
    note(t, "_before")
    t:step("triangle", "Clear the triangle between duct and artery with the hook", {
      limit = 90 * s,
      hint = "lay the hook on a strand, let current flow until it parts, and go to the next; keep off the duct",
    })
    t:wait_until(function() return t:torn("artery_fat") == 1 end)
    t:step("plate", "Take the gallbladder's lower part off the cystic plate", {
      limit = 40 * s,
      hint = "where the lowest lobules of fat join gallbladder and liver, from the triangle's side",
    })
    t:wait_until(function() return view(t).plate.points > 0 end)
    if p.flip then
      t:step("flip", "Turn the pouch over and take the plate's right side", {
        limit = 50 * s,
        hint = "swing the pouch to the patient's left and up; a hook by the right port reaches what is left below",
      })
      t:wait_until(function() return view(t).plate.points > 1 end)
    end
    t:wait(0.8 * s)
    note(t, "")
  end,

  demo = function(t, p)
    local begun = t:time()
    local function gives_up() return p.demo == "bail_out" and t:time() - begun > 24 * s end

    t:together(function()
      t.left:approach("gallbladder.infundibulum", { speed = 60 * mm / s, depth = 3.5 * mm })
      t.left:close()
      t.left:move_by({ -14 * mm, -13 * mm, 3 * mm }, { speed = 8 * mm / s })
    end, function()
      t.hook:rotate(180 * deg, { speed = 400 * deg / s }) -- its foot points to the patient's right
      t.hook:move_to({ -30 * mm, 120 * mm, -80 * mm }, { speed = 60 * mm / s })
    end)
    t.left:wait(0.3 * s)
    if p.demo == "clumsy" then t.hook:activate(0.5 * s) end
    technique.take(t, t.hook, "artery_fat", {
      port = hook_port, tries = 4, hardest = 0.4 * N,
      keep_off = {
        { organ = "common_duct", place = t:place("cystic_duct.end"), clear = 3.5 * mm },
        { organ = "gallbladder", clear = 0.1 * mm }, -- on the wall current is a hole
      },
      is_done = function() return p.demo == "clumsy" and t:torn("artery_fat") > 0.2 or gives_up() end,
    })
    if p.demo == "clumsy" then return end
    if p.demo == "bail_out" then return t:bail_out("subtotal cholecystectomy: the triangle does not open") end
    t.hook:rotate(-180 * deg, { speed = 400 * deg / s })
    technique.hook(t, t.hook, "cystic_plate", {
      port = hook_port, hardest = 0.8 * N, between = { "liver", "gallbladder" },
      wanted = function(strand) return strand.share <= lower_part end,
      is_done = function() return view(t).plate.points > 0 end,
    })
    t.hook:move_by({ 10 * mm, 0, 40 * mm }, { speed = 100 * mm / s })
    if not p.flip then return end
    turn_over(t)
    technique.hook(t, t.side_hook, "cystic_plate", {
      port = side_port, hardest = 0.8 * N, between = { "liver", "gallbladder" },
      wanted = function(strand) return strand.share <= lower_part end,
      is_done = function() return view(t).plate.points > 1 end,
    })
    t.side_hook:move_to({ -120 * mm, 60 * mm, -30 * mm }, { speed = 100 * mm / s })
  end,

  score = function(p)
    local hooks = p.flip and { "hook", "side_hook" } or { "hook" }
    local parts = {
      { calot.score.rule(judge_view), name = "critical_view", weight = 0.7 },
      { calot.score.penalty { event = "dry_activation", each = 0.25 }, weight = 0.15 },
      critical = { "overforce", "perforation" },
      bail_out = judge_bail_out,
      cap = 40,
      pass = 80,
    }
    for _, hook in ipairs(hooks) do
      local force = calot.score.benchmark { metric = hook .. ".peak_jaws_force_N", novice = 3, expert = 1.5 }
      parts[#parts + 1] = { force, weight = 0.15 / #hooks }
    end
    return calot.score.weighted(parts)
  end,

  golden = {
    moments = {
      { name = "fundus_lifted", step = "triangle", delay = 1.12 * s },
      { name = "third_strand", event = "divided", organ = "artery_fat", count = 3, delay = 0.32 * s },
      { name = "plate_opens", event = "divided", organ = "cystic_plate" },
      { name = "critical_view", event = "step_done", step = "plate" },
    },
  },
}
