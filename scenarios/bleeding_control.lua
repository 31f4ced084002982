-- A vessel bleeds: the cystic artery is torn across, and its stump on the patient's side has to be clipped within ten
-- seconds. The mistake is a parameter, demo = "clumsy": a clip is fired blindly.

local calot = require "calot"
local anatomy = require "anatomy"
local technique = require "technique"
local mm, s, deg = calot.units.mm, calot.units.s, calot.units.deg

local stump = "cystic_artery.patient"
local port = { -10 * mm, 120 * mm, -5 * mm }

--- Full points for what is lost while a clip is brought as fast as an expert can, none for five times that.
local function judge_blood(run)
  local few, many = 2, 10 -- mL
  local lost = run.metrics["total.blood_lost_mL"] or many -- of a session that never began nothing was measured
  local share = math.max(0, math.min(1, (many - lost) / (many - few)))
  return share, ("%.1f mL of blood were lost; %d mL or less earn all, %d mL nothing"):format(lost, few, many),
    run:times("bleeding")
end

return calot.exercise {
  api = 2,
  id = "bleeding-control",
  title = "A torn cystic artery is clipped while it bleeds",
  time_limit = 45 * s,

  params = {
    demo = {
      type = "choice",
      default = "expert",
      choices = { "expert", "clumsy" },
      title = "how the demo goes about it: one clip where it bleeds, or one fired blindly first",
    },
  },

  scene = function()
    return {
      anatomy = anatomy.standard { without = { "cystic_duct", "hilar_fat", "cystic_node" } },
      ports = { scope = { -40 * mm, 20 * mm, 10 * mm } },
      instruments = { applier = { type = "clip_applier", port = "epigastric" } },
      laparoscope = { port = "scope", angle = 0, look_at = "cystic_artery.middle", distance = 85 * mm },
      solver = { motion = "dynamic", rate = 25 },
    }
  end,

  steps = function(t)
    t:step("stand_by", "Bring the clip applier to the cystic artery", {
      limit = 25 * s,
      hint = "to within 30 mm of it, in view",
    })
    if not t:wait_until(function() return t.applier:distance("cystic_artery.middle") < 30 * mm end) then return end
    t:step("stop", "It tears: clip the stump that bleeds, on the patient's side", {
      limit = 20 * s,
      hint = "both legs past it, and look at their tips before you fire; ten seconds are asked for",
    })
    t:divide("cystic_artery", 0.55)
    t:wait_until(function() return technique.shut(t, stump) >= 1 end)
    t:wait(0.6 * s)
  end,

  demo = function(t, p)
    local clips = technique.hand(t, "applier", port)
    t.applier:open(20 * deg)
    clips.about("cystic_artery", 0.4, -20 * mm, 120 * mm / s)
    t:wait_until(function() return t:divided("cystic_artery") end)
    if p.demo == "clumsy" then
      t.applier:fire()
      t:wait(14 * s)
    end
    clips.set_clips(stump, { 0.5 }, 20 * deg, 4 * mm)
    clips.back(20 * mm)
  end,

  score = calot.score.weighted {
    { calot.score.rule(judge_blood), name = "blood", weight = 0.5, steps = { "stop" } },
    { calot.score.benchmark { metric = "stop.time_s", novice = 20, expert = 10 }, weight = 0.3, steps = { "stop" } },
    { calot.score.penalty { event = "clip_dropped", each = 0.5 }, weight = 0.2 },
    critical = { "injury", "perforation", "cut_liver" },
    pass = 70,
  },

  golden = { at = { 1.52 * s, 2.6 * s, 3.72 * s } },
}
