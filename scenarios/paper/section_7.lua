-- Section 7 of Moutsopoulos and Gillies (1997), the groupstructure: a gallbladder that lies on its ground is taken by
-- its fundus, lifted off, shifted across until the cystic duct, which a common duct ties to the patient, holds it back,
-- and laid down again, while a blunt rod pushes on its neck. Organs, ducts and ground are one equilibrium, with masses.

local calot = require "calot"
local mm, s, kPa = calot.units.mm, calot.units.s, calot.units.kPa

local ground = -120 * mm
local neck, fundus = { -58 * mm, 112 * mm, -109 * mm }, { -108 * mm, 78 * mm, -101 * mm }
local junction = { -26 * mm, 126 * mm, -112 * mm }

return calot.exercise {
  api = 2,
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
            shape = {
              type = "tube",
              points = { neck, { -45 * mm, 121 * mm, -110 * mm }, junction },
              radius = 2.2 * mm,
            },
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
      ports = { scope = { -60 * mm, -30 * mm, 10 * mm } },
      instruments = {
        left = { port = "right_lateral" },
        right = { port = "epigastric", type = "bipolar_electrode" },
      },
      solver = { motion = "dynamic" },
      laparoscope = { port = "scope", look_at = "gallbladder.body", distance = 135 * mm },
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
    t.right:move_to({ -66 * mm, 125 * mm, -75 * mm }, { speed = 60 * mm / s })
    t.left:approach("gallbladder.fundus", { speed = 60 * mm / s })
    t.left:close()
    t.left:move_by({ 0, 0, 30 * mm }, { speed = 25 * mm / s }) -- off the ground
    t.left:move_by({ -10 * mm, -32 * mm, 0 }, { speed = 25 * mm / s }) -- across, until the duct holds it back
    t.right:move_by({ -26 * mm, -30 * mm, -22 * mm }, { speed = 20 * mm / s }) -- and a push on its body
    t.left:wait(0.5 * s)
    t.right:move_by({ 26 * mm, 30 * mm, 22 * mm }, { speed = 20 * mm / s })
    t.left:move_by({ 10 * mm, 32 * mm, 0 }, { speed = 25 * mm / s })
    t.left:move_by({ 0, 0, -29 * mm }, { speed = 25 * mm / s })
    t.left:open()
    t.left:move_by({ -10 * mm, -10 * mm, 20 * mm })
    t.left:wait(2 * s)
  end,

  golden = { at = { 0, 5.5 * s, 9 * s, 17 * s } },
}
