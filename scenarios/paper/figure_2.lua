-- Figure 2 of Moutsopoulos and Gillies (1997): a spherical membrane filled with bile on a supporting plane, handled
-- by two instruments: the atraumatic grasping forceps pull a fold up, the bipolar electrode with channel pushes the
-- wall in. 61 control nodes, as in the paper.

local calot = require "calot"
local mm, s, N, kPa = calot.units.mm, calot.units.s, calot.units.N, calot.units.kPa

return calot.exercise {
  api = 2,
  id = "paper-figure-2",
  title = "The paper's sphere, pulled by a grasper and pushed by an electrode",
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
            liver_side = { -1, 0, 0 },
            bile = { fill_pressure = 0.8 * kPa },
            -- A ball on a smooth plane would roll: it grows on it, firmly enough not to lean.
            held = { { name = "base", landmark = "neck", radius = 10 * mm, stiffness = 4e6 } },
          },
        },
      },
      solver = { extensions = { levels = 1 } },
      laparoscope = { look_at = "sphere.fundus", distance = 60 * mm },
      instruments = {
        left = { type = "atraumatic_grasper", port = "right_subcostal" },
        right = { type = "bipolar_electrode", port = "left_upper", force_limit = 2 * N },
      },
    }
  end,

  steps = function(t)
    t:step("grasp", "Grasp the top", { limit = 20 * s })
    t:wait_until(function() return t.left:holds("sphere") end)
    t:step("push", "Pull the fold up and push the wall in beside it", { limit = 20 * s })
    t:wait_until(function() return t.right:touching() and t.right:force() > 0.3 * N end)
    t:step("show", "Hold both still", { limit = 20 * s })
    t:hold("both", function() return t.left:holds("sphere") and t.right:touching() end, 2 * s)
  end,

  demo = function(t)
    t.left:approach("sphere.fundus", { speed = 40 * mm / s, offset = { -6 * mm, 0, -1 * mm } })
    t.left:close()
    t:together(
      function() t.left:move_by({ -3 * mm, 0, 9 * mm }, { speed = 10 * mm / s }) end,
      function() t.right:approach("sphere.body", { depth = 7 * mm, offset = { -3 * mm, -6 * mm, 8 * mm } }) end
    )
    t:wait(3 * s)
  end,

  golden = { at = { 3.6 * s, 8 * s } },
}
