-- A cost to measure: two graspers hold folds of the gallbladder and do not move.
local calot = require "calot"
local mm, s, deg = calot.units.mm, calot.units.s, calot.units.deg

return calot.exercise {
  api = 1,
  id = "two-hold-still",
  title = "Hold two folds still",
  time_limit = 60 * s,
  params = { skip_still = { type = "boolean", default = true } },
  scene = function(p)
    local solver = { rate = 50, tolerance = 1e-6, extensions = { levels = 1 } }
    -- Only said where it is wanted: programs that know no such key are measured too.
    if not p.skip_still then solver.skip_still = false end
    return {
      anatomy = calot.anatomy("standard"),
      solver = solver,
      laparoscope = { port = "umbilical", angle = 30 * deg, look_at = "gallbladder.fundus" },
      instruments = {
        left = { type = "atraumatic_grasper", port = "right_subcostal" },
        right = { type = "atraumatic_grasper", port = "epigastric" },
      },
    }
  end,
  steps = function(t)
    t:step("hold", "Hold both", { limit = 55 * s })
    t:wait_until(function() return t.left:holds("gallbladder") and t.right:holds("gallbladder") end)
    t:wait(40 * s)
  end,
  demo = function(t)
    t.left:approach("gallbladder.fundus", { speed = 40 * mm / s })
    t.left:close()
    t.left:move_by({ 0, 2 * mm, 5 * mm }, { speed = 10 * mm / s })
    -- Onto the side of the body, 25 mm from the fundus, that faces the epigastric port.
    t.right:open()
    t.right:move_to({ -57 * mm, 113 * mm, -62 * mm }, { speed = 40 * mm / s })
    t.right:move_to({ -63 * mm, 112 * mm, -71 * mm }, { speed = 20 * mm / s })
    t.right:close()
    t.right:wait(40 * s)
  end,
  score = calot.score.weighted {
    { calot.score.benchmark { metric = "total.time_s", novice = 60, expert = 20 }, weight = 1 },
  },
}
