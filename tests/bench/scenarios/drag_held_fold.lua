-- A cost to measure: a grasper holds a fold of the fundus and draws it to and fro at 5 mm/s, turns it by a whole
-- turn in 4 s, or does nothing with it.
local calot = require "calot"
local mm, s, deg = calot.units.mm, calot.units.s, calot.units.deg

return calot.exercise {
  api = 1,
  id = "drag-held-fold",
  title = "Draw a held fold to and fro",
  time_limit = 60 * s,
  params = {
    motion = {
      type = "choice",
      default = "drag",
      choices = { "drag", "turn", "none" },
      title = "what it does with it",
    },
  },
  scene = function()
    return {
      anatomy = calot.anatomy("standard"),
      solver = { rate = 50, tolerance = 1e-6, extensions = { levels = 1 } },
      laparoscope = { port = "umbilical", angle = 30 * deg, look_at = "gallbladder.fundus" },
      instruments = { left = { type = "atraumatic_grasper", port = "right_subcostal" } },
    }
  end,
  steps = function(t)
    t:step("drag", "Draw it", { limit = 40 * s })
    t:wait_until(function() return t.left:holds("gallbladder") end)
    t:wait(8 * s)
  end,
  demo = function(t, p)
    t.left:approach("gallbladder.fundus", { speed = 40 * mm / s })
    t.left:close()
    if p.motion == "turn" then t.left:rotate(360 * deg, { speed = 90 * deg / s }) end
    if p.motion ~= "drag" then return end
    t.left:move_by({ 0, 2 * mm, 6 * mm }, { speed = 5 * mm / s })
    for _ = 1, 3 do
      t.left:move_by({ 5 * mm, 0, 0 }, { speed = 5 * mm / s })
      t.left:move_by({ -5 * mm, 0, 0 }, { speed = 5 * mm / s })
    end
  end,
  score = calot.score.weighted {
    { calot.score.benchmark { metric = "total.time_s", novice = 60, expert = 20 }, weight = 1 },
  },
}
