-- Figure 4 of Moutsopoulos and Gillies (1997): a spherical membrane filled with bile on a supporting plane, handled
-- by the atraumatic grasping forceps. 61 control nodes, as in the paper.

local calot = require "calot"
local mm, s, kPa = calot.units.mm, calot.units.s, calot.units.kPa

return calot.exercise {
  api = 2,
  id = "paper-figure-4",
  title = "The paper's sphere, lifted by one grasper",
  time_limit = 60 * s,

  scene = function()
    return {
      anatomy = {
        table_head_up = 0,
        table_left_down = 0,
        support = { point = { -50 * mm, 110 * mm, -120.6 * mm } },
        organs = {
          {
            name = "sphere",
            shape = { type = "sphere", radius = 20 * mm },
            nodes = 61,
            neck = { -50 * mm, 110 * mm, -120 * mm },
            fundus = { -50 * mm, 110 * mm, -80 * mm },
            bile = { fill_pressure = 0.8 * kPa },
            -- A ball on a smooth plane would roll: it grows on it, firmly enough not to lean.
            held = { { name = "base", landmark = "neck", radius = 10 * mm, stiffness = 4e6 } },
          },
        },
      },
      solver = { extensions = { levels = 1 } },
      laparoscope = { look_at = "sphere.fundus", distance = 60 * mm },
      instruments = { left = { port = "right_subcostal" } },
    }
  end,

  steps = function(t)
    t:step("grasp", "Grasp the top", { limit = 20 * s })
    t:wait_until(function() return t.left:holds("sphere") end)
    t:step("lift", "Lift it by a quarter of its height and hold", { limit = 20 * s })
    t:wait(3 * s)
  end,

  demo = function(t)
    t.left:approach("sphere.fundus", { speed = 40 * mm / s })
    t.left:close()
    t.left:move_by({ 0, 0, 10 * mm }, { speed = 10 * mm / s })
  end,

  golden = { at = { 0, 2.2 * s, 5 * s } },
}
