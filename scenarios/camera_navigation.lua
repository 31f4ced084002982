-- The camera holder: eight places of the field shown by a 30 degree laparoscope whose horizon is held by hand.

local calot = require "calot"
local anatomy = require "anatomy"
local mm, s, deg = calot.units.mm, calot.units.s, calot.units.deg

local targets = {
  { name = "show_fundus", place = "gallbladder.fundus", title = "the gallbladder's fundus" },
  { name = "show_body", place = "gallbladder.free_side", title = "its body, on the free side" },
  { name = "show_pouch", place = "gallbladder.infundibulum", title = "Hartmann's pouch" },
  { name = "show_neck", place = "gallbladder.neck", title = "the gallbladder's neck" },
  { name = "show_duct", place = "cystic_duct.middle", title = "the cystic duct" },
  { name = "show_union", place = "cystic_duct.end", title = "where it enters the common duct" },
  { name = "show_common_duct", place = "common_duct.middle", title = "the common duct below it" },
  { name = "show_hepatic_artery", place = "right_hepatic_artery.middle", title = "the right hepatic artery" },
}

-- What is asked for: in the middle of the picture, from near by, and level.
local middle, nearest, farthest, level = 0.35, 40 * mm, 75 * mm, 8 * deg

return calot.exercise {
  api = 2,
  id = "camera-navigation",
  title = "Eight places shown by a 30 degree laparoscope",
  time_limit = 120 * s,

  params = {
    demo = {
      type = "choice",
      default = "expert",
      choices = { "expert", "clumsy" },
      title = "who holds the camera in the demonstration",
    },
  },

  scene = function()
    return {
      anatomy = anatomy.standard(),
      ports = { scope = { -40 * mm, 20 * mm, 10 * mm } },
      instruments = { left = { port = "right_lateral" } },
      laparoscope = {
        port = "scope",
        angle = 30 * deg,
        look_at = "cystic_duct.start",
        distance = 105 * mm,
        horizon = "held",
      },
      solver = { motion = "dynamic" },
    }
  end,

  steps = function(t)
    local scope = t.laparoscope
    for number, target in ipairs(targets) do
      t:step(target.name, ("Show %s, %d of %d"):format(target.title, number, #targets), {
        limit = 30 * s,
        hint = "have it within the middle third of the picture, from 40 to 75 mm, with the horizon level, for a second",
      })
      t:hold("shown", function()
        local distance = scope:distance(target.place)
        if distance < nearest or distance > farthest or math.abs(scope:horizon()) > level then return false end
        local x, y = scope:picture(target.place)
        return x and x * x + y * y < middle * middle and t:sees(target.place)
      end, 1 * s)
    end
  end,

  demo = function(t, p)
    local scope = t.laparoscope
    for _, target in ipairs(targets) do
      if p.demo == "clumsy" then
        scope:move_to(target.place)
        scope:rotate(25 * deg)
        scope:rotate(-25 * deg)
      end
      scope:look_at(target.place, { distance = 60 * mm, speed = 40 * mm / s })
      t:wait(1.2 * s)
    end
  end,

  score = calot.score.weighted {
    { calot.score.benchmark { metric = "total.time_s", novice = 100, expert = 30 }, weight = 0.3 },
    { calot.score.benchmark { metric = "laparoscope.path_length_mm", novice = 900, expert = 300 }, weight = 0.3 },
    { calot.score.benchmark { metric = "laparoscope.horizon_off_deg", novice = 12, expert = 3 }, weight = 0.2 },
    { calot.score.penalty { event = "contact", each = 0.25 }, weight = 0.2 },
    critical = { "perforation", "injury", "cut_liver" },
    pass = 70,
  },

  golden = { at = { 0, 2.1 * s, 6.2 * s, 9.8 * s, 13 * s } },
}
