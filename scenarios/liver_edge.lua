local calot = require "calot"
local technique = require "technique"
local mm, s, kPa, deg = calot.units.mm, calot.units.s, calot.units.kPa, calot.units.deg

local neck, fundus, liver_side = { -50 * mm, 130 * mm, -110 * mm }, { -80 * mm, 100 * mm, -60 * mm }, { 0, 0.8, 0.6 }

local up = { 0, 0.55, 0.83 }

return calot.exercise {
  api = 2,
  id = "liver-edge",
  title = "A gallbladder pushed over the liver's edge",
  time_limit = 30 * s,

  scene = function()
    return {
      anatomy = {
        organs = {
          {
            name = "gallbladder",
            neck = neck,
            fundus = fundus,
            liver_side = liver_side,
            shape = { type = "pear", length = 75 * mm, width = 35 * mm },
            nodes = 150,
            bile = { fill_pressure = 1.6 * kPa },
            held = {
              { name = "root", landmark = "neck", radius = 12 * mm, stiffness = 3e5 },
              { name = "bed", landmark = "bed", radius = 18 * mm, stiffness = 1e5 },
            },
          },
          {
            name = "liver",
            neck = neck,
            fundus = fundus,
            liver_side = liver_side,
            shape = { type = "lobe", bed_length = 75 * mm },
          },
        },
      },
      ports = { scope = { -130 * mm, 20 * mm, 0 } },
      instruments = { left = { port = "right_subcostal" } },
      laparoscope = { port = "scope", angle = 0, look_at = "gallbladder.fundus", distance = 110 * mm },
    }
  end,

  steps = function(t)
    t:step("grasp", "Take the gallbladder by its fundus", { limit = 15 * s })
    t:wait_until(function() return t.left:holds("gallbladder") end)

    t:step("push", "Push it up over the liver's edge and keep it there for 2 s", { limit = 15 * s })
    local hung = t:place("gallbladder.fundus")
    t:hold("up", function()
      local way = technique.minus(t:place("gallbladder.fundus"), hung)
      return t.left:holds("gallbladder") and technique.dot(way, up) > 30 * mm
    end, 2 * s)
  end,

  demo = function(t)
    t.left:approach("gallbladder.fundus", { speed = 60 * mm / s })
    t.left:close()
    -- Drawn that far the fold turns about the shaft. The hand turns with it, or it would turn between the pads (slip).
    for _ = 1, 5 do
      t.left:move_by({ 0, 6 * mm, 9 * mm }, { speed = 20 * mm / s })
      t.left:rotate(18 * deg)
    end
    t.left:wait(1 * s)
  end,

  score = calot.score.weighted {
    { calot.score.benchmark { metric = "left.path_length_mm", novice = 900, expert = 250 }, weight = 0.7 },
    { calot.score.penalty { event = "slip", each = 0.5 }, weight = 0.3 },
  },
  golden = { at = { 0, 6 * s } },
}
