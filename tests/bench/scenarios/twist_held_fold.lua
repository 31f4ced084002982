-- A cost to measure: a grasper holds a fold of the fundus and turns it by a whole turn at 90 degrees a second.
local calot = require "calot"
local mm, s, deg = calot.units.mm, calot.units.s, calot.units.deg

return calot.exercise {
  api = 1,
  id = "twist-held-fold",
  title = "Turn a held fold by a whole turn",
  time_limit = 60 * s,
  params = { turn = { type = "number", default = 360, min = 0, max = 360, title = "by how much, degrees" } },
  scene = function()
    return {
      anatomy = calot.anatomy("standard"),
      solver = { rate = 50, tolerance = 1e-6, extensions = { levels = 1 } },
      laparoscope = { port = "umbilical", angle = 30 * deg, look_at = "gallbladder.fundus" },
      instruments = { left = { type = "atraumatic_grasper", port = "right_subcostal" } },
    }
  end,
  steps = function(t)
    t:step("hold", "Hold it", { limit = 40 * s })
    t:wait_until(function() return t.left:holds("gallbladder") end)
    t:step("turn", "Turn it", { limit = 20 * s })
    t:wait(4.5 * s)
  end,
  demo = function(t, p)
    t.left:approach("gallbladder.fundus", { speed = 40 * mm / s })
    t.left:close()
    if p.turn > 0 then t.left:rotate(p.turn * deg, { speed = 90 * deg / s }) end
    t.left:wait(1 * s)
  end,
  score = calot.score.weighted {
    { calot.score.benchmark { metric = "total.time_s", novice = 60, expert = 20 }, weight = 1 },
  },
}
