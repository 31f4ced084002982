-- The field of a cholecystectomy at rest: liver, gallbladder with pouch and neck, ducts and arteries, and the tissue
-- that holds them together.

local calot = require "calot"
local anatomy = require "anatomy"
local mm, s = calot.units.mm, calot.units.s

return calot.exercise {
  api = 2,
  id = "operating-field",
  title = "The operating field at rest",
  time_limit = 10 * s,

  params = {
    variant = {
      type = "choice",
      default = "standard",
      choices = {
        "standard", "varied", "short_cystic_duct", "low_union", "double_cystic_artery", "hepatic_artery_near_neck",
        "hydrops", "phrygian_cap", "dilated_common_duct", "aberrant_right_duct",
      },
      title = "whose field: the standard one, one drawn by the seed, or a variant",
    },
  },

  scene = function(p)
    local made = { standard = anatomy.standard, varied = anatomy.varied }
    return {
      anatomy = made[p.variant] and made[p.variant]() or anatomy.variant(p.variant),
      ports = { scope = { -40 * mm, 20 * mm, 10 * mm } },
      instruments = { left = { port = "right_lateral" } },
      laparoscope = { port = "scope", angle = 0, look_at = "cystic_duct.start", distance = 105 * mm },
      solver = { motion = "dynamic" },
    }
  end,

  steps = function(t)
    t:step("look", "Name what enters the gallbladder", { limit = 5 * s })
    t:wait(1 * s)
  end,

  demo = function(t) t.left:wait(1 * s) end,
}
