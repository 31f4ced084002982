-- The field of a cholecystectomy at rest: liver, gallbladder with pouch and neck, ducts and arteries, and the tissue
-- that holds them together.

local calot = require "calot"
local anatomy = require "anatomy"
local mm, s = calot.units.mm, calot.units.s

return calot.exercise {
  api = 1,
  id = "operating-field",
  title = "The operating field at rest",
  time_limit = 10 * s,

  scene = function()
    return {
      anatomy = anatomy.standard(),
      ports = { scope = { -25 * mm, 10 * mm, -20 * mm } },
      instruments = { left = { port = "right_lateral" } },
      laparoscope = { port = "scope", angle = 0, look_at = "cystic_duct.middle", distance = 95 * mm },
      solver = { motion = "dynamic" },
    }
  end,

  steps = function(t)
    t:step("look", "Name what enters the gallbladder", { limit = 5 * s })
    t:wait(1 * s)
  end,

  demo = function(t) t.left:wait(1 * s) end,

  score = calot.score.weighted {
    { calot.score.benchmark { metric = "gallbladder.max_stretch", novice = 2.2, expert = 1.5 }, weight = 1 },
  },
  golden = { at = { 0, 1 * s } },
}
