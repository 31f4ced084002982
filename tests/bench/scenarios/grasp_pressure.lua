-- A curve to look at: a grasper takes the fundus of a gallbladder that is filled to so many mmHg, and draws it
-- away by 60 mm.
local calot = require "calot"
local mm, s, deg, kPa = calot.units.mm, calot.units.s, calot.units.deg, calot.units.kPa

return calot.exercise {
  api = 1,
  id = "grasp-pressure",
  title = "Draw a fold of the fundus",
  time_limit = 60 * s,
  params = { mmHg = { type = "number", default = 10, min = 0, max = 30 } },
  scene = function(p)
    local gallbladder = {
      name = "gallbladder",
      nodes = 120,
      held = { { name = "bed", landmark = "bed" } },
      bile = { fill_pressure = p.mmHg * 0.1333 * kPa },
    }
    return {
      anatomy = { organs = { gallbladder } },
      solver = { rate = 50, extensions = { levels = 1 } },
      laparoscope = { port = "umbilical", angle = 30 * deg, look_at = "gallbladder.fundus" },
      instruments = { left = { type = "atraumatic_grasper", port = "right_subcostal" } },
    }
  end,
  steps = function(t)
    t:step("draw", "Draw it", { limit = 30 * s })
    t:wait(8 * s)
  end,
  demo = function(t)
    t.left:approach("gallbladder.fundus", { speed = 40 * mm / s })
    t.left:close()
    t.left:move_by({ 0, 0, 60 * mm }, { speed = 20 * mm / s })
  end,
  score = calot.score.weighted {
    { calot.score.benchmark { metric = "total.time_s", novice = 60, expert = 20 }, weight = 1 },
  },
}
