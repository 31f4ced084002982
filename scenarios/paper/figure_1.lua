-- Figure 1 of Moutsopoulos and Gillies (1997): the coarse elements (black) and, around the place where an instrument
-- meets the membrane, those of its structural extension (steel), of two levels. Beads are nodes: the extension's
-- are the paper's P0 and Pi'.

local calot = require "calot"
local mm, s, kPa = calot.units.mm, calot.units.s, calot.units.kPa

return calot.exercise {
  api = 2,
  id = "paper-figure-1",
  title = "The structural extension around a contact",
  time_limit = 60 * s,

  scene = function()
    return {
      anatomy = {
        table_head_up = 0,
        table_left_down = 0,
        organs = {
          {
            name = "sphere",
            shape = { type = "sphere", radius = 20 * mm },
            nodes = 61,
            neck = { -50 * mm, 110 * mm, -120 * mm },
            fundus = { -50 * mm, 110 * mm, -80 * mm },
            bile = { fill_pressure = 0.8 * kPa },
            held = { { name = "base", landmark = "neck", radius = 16 * mm, stiffness = 1e6 } },
          },
        },
      },
      solver = { extensions = { levels = 2 } },
      laparoscope = { look_at = "sphere.fundus", distance = 60 * mm, show_structure = true },
      instruments = { left = { port = "right_subcostal" } },
    }
  end,

  steps = function(t)
    t:step("press", "Press the top with closed jaws", { limit = 20 * s })
    t:wait_until(function() return t.left:touching() end)
    t:wait(2 * s)
  end,

  demo = function(t)
    t.left:approach("sphere.fundus", { speed = 40 * mm / s, depth = -4 * mm, jaw = 0 })
    t.left:move_by({ 0, 0, -8 * mm }, { speed = 8 * mm / s })
    t.left:wait(3 * s)
  end,

  golden = { at = { 2 * s } },
}
