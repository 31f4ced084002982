-- A cost to measure: the pouch is taken and drawn to the side, in a field with so many strands of tissue.
local calot = require "calot"
local anatomy = require "anatomy"
local mm, s = calot.units.mm, calot.units.s

local usual = 0
for _, tissue in ipairs(anatomy.standard({}).tissue) do usual = usual + tissue.strands end

return calot.exercise {
  api = 1,
  id = "strands",
  title = "Draw the pouch aside",
  time_limit = 20 * s,
  params = {
    strands = { type = "number", default = usual, min = 50, max = 1500, title = "strands of tissue, in all" },
  },
  scene = function(p)
    return {
      anatomy = anatomy.standard { strands = p.strands / usual },
      ports = { scope = { -40 * mm, 20 * mm, 10 * mm } },
      instruments = { left = { port = "right_subcostal" } },
      laparoscope = { port = "scope", angle = 0, look_at = "gallbladder.infundibulum", distance = 120 * mm },
      solver = { motion = "dynamic", skip_still = false },
    }
  end,
  steps = function(t)
    t:step("draw", "Draw it aside", { limit = 15 * s })
    t:wait(4 * s)
  end,
  demo = function(t)
    t.left:approach("gallbladder.infundibulum", { speed = 60 * mm / s })
    t.left:close()
    t.left:move_by({ -8 * mm, -4 * mm, 4 * mm }, { speed = 10 * mm / s })
  end,
  score = calot.score.weighted {
    { calot.score.benchmark { metric = "total.time_s", novice = 60, expert = 4 }, weight = 1 },
  },
}
