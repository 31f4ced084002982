local calot = require "calot"
local anatomy = require "anatomy"
local mm, s, N = calot.units.mm, calot.units.s, calot.units.N

return calot.exercise {
  api = 1,
  id = "exposure",
  title = "Expose Calot's triangle",
  time_limit = 60 * s,
  params = {
    traction = { type = "choice", default = "lateral", choices = { "lateral", "cephalad" } },
  },
  scene = function()
    return {
      anatomy = anatomy.standard(),
      ports = { scope = { -40 * mm, 20 * mm, 10 * mm } },
      instruments = { left = { port = "right_lateral", force_limit = 5 * N } },
      laparoscope = { port = "scope", angle = 0, look_at = "cystic_duct.start", distance = 105 * mm },
      solver = { motion = "dynamic" },
    }
  end,
  steps = function(t)
    t:step("grasp", "Take the pouch", { limit = 15 * s })
    t:wait_until(function() return t.left:holds("gallbladder") end)
    t:step("expose", "Open the triangle", { limit = 15 * s })
    t:wait(2.5 * s)
    local a, b, c = t:place("cystic_duct.start"), t:place("cystic_duct.end"), t:place("common_duct.start")
    t:note("seen_mm2", t:seen_area(a, b, c) * 1e6, "mm2")
  end,
  demo = function(t)
    t.left:approach("gallbladder.infundibulum", { speed = 60 * mm / s, depth = 4 * mm })
    t.left:close()
    t.left:move_by({ -20 * mm, -12 * mm, 8 * mm }, { speed = 15 * mm / s })
    t.left:wait(2 * s)
  end,
  score = calot.score.weighted {
    { calot.score.benchmark { metric = "note.seen_mm2", novice = 20, expert = 100 }, weight = 1 },
  },
}
