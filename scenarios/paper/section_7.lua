-- Section 7 of Moutsopoulos and Gillies (1997), the groupstructure: a gallbladder that lies on its ground is taken by its
-- fundus, lifted off, shifted across and laid down again, while the cystic duct, which a common duct ties to the
-- patient, holds it back. Organs, ducts and ground are one equilibrium, with their masses.
--
-- force_over_way.csv in the run's folder has the pull on the jaws over the way that they went.

local calot = require "calot"
local mm, s, kPa, deg = calot.units.mm, calot.units.s, calot.units.kPa, calot.units.deg

local ground = -120 * mm
local neck, fundus = { -58 * mm, 112 * mm, -109 * mm }, { -108 * mm, 78 * mm, -101 * mm }
local junction = { -26 * mm, 126 * mm, -112 * mm }

return calot.exercise {
  api = 1,
  id = "paper-section-7",
  title = "A gallbladder lifted off its ground, held by its duct",
  time_limit = 30 * s,

  scene = function()
    return {
      anatomy = {
        table_head_up = 0,
        table_left_down = 0,
        ground = { { name = "ground", point = { 0, 0, ground }, friction = 0.1 } },
        organs = {
          {
            name = "gallbladder",
            neck = neck,
            fundus = fundus,
            liver_side = { 0, 0, -1 },
            shape = { type = "pear", length = 70 * mm, width = 32 * mm, refine = 2 },
            nodes = 150,
            wall = { density = 1050 },
            bile = { fill_pressure = 1.2 * kPa },
          },
          {
            name = "cystic_duct",
            shape = { type = "tube", points = { neck, { -45 * mm, 121 * mm, -110 * mm }, junction }, radius = 2.2 * mm },
            wall = { thickness = 0.8 * mm, density = 1050 },
          },
          {
            name = "common_duct",
            shape = {
              type = "tube",
              points = { { -30 * mm, 160 * mm, -108 * mm }, junction, { -22 * mm, 92 * mm, -112 * mm } },
              radius = 3.2 * mm,
            },
            wall = { thickness = 1 * mm, density = 1050 },
            held = {
              { name = "hepatic", landmark = "start", radius = 8 * mm, stiffness = 1e6 },
              { name = "duodenal", landmark = "end", radius = 8 * mm, stiffness = 1e6 },
            },
          },
        },
        joints = {
          { from = "cystic_duct.start", to = "gallbladder.neck", radius = 4 * mm },
          { from = "cystic_duct.end", to = "common_duct.middle", radius = 4 * mm },
        },
      },
      instruments = { left = { port = "right_lateral" } },
      solver = { motion = "dynamic" },
      laparoscope = { look_at = "gallbladder.body", distance = 100 * mm },
    }
  end,

  steps = function(t)
    t:step("grasp", "Take the gallbladder by its fundus", { limit = 15 * s })
    t:wait_until(function() return t.left:holds("gallbladder") end)

    t:step("lift", "Lift it off its ground and shift it across", { limit = 30 * s })
    t:wait_until(function() return not t.left:holds() end)
    t:wait(2 * s) -- it comes to rest
  end,

  demo = function(t)
    t.left:approach("gallbladder.fundus", { speed = 60 * mm / s })
    t.left:close()
    t.left:move_by({ 0, 0, 35 * mm }, { speed = 25 * mm / s }) -- off the ground
    t.left:move_by({ -15 * mm, -40 * mm, 0 }, { speed = 25 * mm / s }) -- across, until the duct holds it back
    t.left:wait(1 * s)
    t.left:move_by({ 0, 0, -33 * mm }, { speed = 25 * mm / s })
    t.left:open()
    t.left:move_by({ 0, 0, 30 * mm })
    t.left:wait(2 * s)
  end,

  score = calot.score.weighted {
    { calot.score.benchmark { metric = "left.path_length_mm", novice = 900, expert = 300 }, weight = 1 },
  },
  golden = { at = { 0 } },
}
