-- The gallbladder comes off its bed: duct and artery are divided already, and the plate's lower third is, as the
-- critical view asks for it. The fundus is pushed up over the liver's edge, the pouch is lifted and drawn over it, too,
-- so that the gallbladder is turned over and the areolar plane behind it stands open under tension: from here on the
-- pouch carries it alone. The hook sweeps through the plane from the neck on, in its middle, as off it on one side
-- there is bile, and on the other raw liver. So far it is a fifth of what stands that this exercise asks for. The
-- mistakes are a parameter, demo = "clumsy": current on the gallbladder until its wall is open.

local calot = require "calot"
local anatomy = require "anatomy"
local technique = require "technique"
local mm, s, N, deg = calot.units.mm, calot.units.s, calot.units.N, calot.units.deg

local ports = {
  scope = { 0, 20 * mm, 10 * mm }, -- from the left one sees between gallbladder and liver
  left_upper = { 80 * mm, 80 * mm, -5 * mm }, -- as where one stands between the legs: below what is turned over
}
local rows = 0.2 -- of the plane: of what stands of it

-- Draws on the pouch, over the liver's edge, until it resists: the less, the fewer strands would carry that, as they
-- draw the liver out. The camera looks at a place meanwhile.
local function draw(t, place)
  local firmly = 0.6 * N + 2.5 * N * (1 - t:torn("cystic_plate"))
  t:together(function()
    t.left:move_until(function() return t.left:force("jaws") > firmly end,
      { along = { -0.15, 0.9, 0.4 }, speed = 25 * mm / s, limit = 15 * mm })
  end, function()
    t.laparoscope:look_at(place, { distance = 75 * mm })
  end)
end

-- Lets go and draws back out of the way.
local function let_go(hand)
  hand:open()
  hand:move_by({ -15 * mm, -15 * mm, 30 * mm }, { speed = 60 * mm / s })
end

local function expert(t)
  t.left:move_by({ 0, 9 * mm, 42 * mm }, { speed = 30 * mm / s }) -- off the liver
  t:together(function()
    t.left:move_by({ -4 * mm, 28 * mm, 12 * mm }, { speed = 25 * mm / s }) -- and over its edge
  end, function()
    t.laparoscope:look_at("gallbladder.body", { distance = 75 * mm })
  end)
  let_go(t.fundus) -- the pouch carries it from here on
  technique.free(t, t.hook, "cystic_plate", {
    port = ports.left_upper, from = t:place("liver.underside"), hardest = 0.6 * N,
    between = { "liver", "gallbladder" }, stretch = function(front) draw(t, front.at) end,
    is_done = function() return t:torn("cystic_plate") >= rows end,
  })
  t.hook:move_by({ 20 * mm, -20 * mm, 20 * mm }, { speed = 100 * mm / s })
  t.laparoscope:look_at("liver.underside", { distance = 60 * mm })
  t:wait(2 * s) -- what bleeds or leaks is seen by then
  t:time_out("the bed is dry so far")
end

return calot.exercise {
  api = 2,
  id = "liver-bed",
  title = "Off the liver's bed: a fifth of the plane that stands",
  time_limit = 120 * s,

  params = {
    demo = {
      type = "choice",
      default = "expert",
      choices = { "expert", "clumsy" },
      title = "how the demo goes about it: in the plane, where it is under tension; or on the gallbladder's wall",
    },
  },

  scene = function()
    return {
      anatomy = anatomy.standard {
        assistant = false,
        areolar_plane = true,
        prepared = { cystic_plate = 1 / 3 }, -- its lower third: else there was no critical view
        without = {
          "cystic_node", "hilar_fat", "triangle_fat", "artery_fat", "cystic_artery", "cystic_duct",
          "right_hepatic_artery",
        },
      },
      ports = ports,
      instruments = {
        fundus = { port = "right_lateral", force_limit = 5 * N, pinch_force = 12 * N }, -- above 15 N it would harm
        left = { port = "right_subcostal", force_limit = 8 * N, pinch_force = 12 * N },
        hook = { type = "l_hook", port = "left_upper", force_limit = 3 * N, power = 30 },
      },
      laparoscope = { port = "scope", angle = 30 * deg, look_at = "gallbladder.infundibulum", distance = 90 * mm },
      solver = { motion = "dynamic", rate = 25 }, -- as critical_view.lua
    }
  end,

  steps = function(t)
    technique.lift_step(t)
    t:step("open", "Take the pouch and draw it over the liver's edge, until the plane behind is under tension", {
      limit = 20 * s,
      hint = "lift it off the liver, then turn it over: towards the patient's right shoulder; look in from below",
    })
    t:wait_until(function() return t.left:holds("gallbladder") and t.left:force("jaws") > 2 * N end)
    t:step("free", "Divide a fifth of the plane with the hook, midway between gallbladder and liver", {
      limit = 70 * s,
      hint = "sweep the foot along the taut strands and let current flow while it lies on them; let the fundus go, and "
        .. "draw the pouch on as they yield, the less the fewer of them are left",
    })
    t:wait_until(function() return t:torn("cystic_plate") >= rows end)
    t:step("look", "Look whether the bed is dry, and say so", {
      limit = 10 * s,
      hint = "hook out of the way, then a time-out",
    })
    t:wait_until(function() return t:count("time_out") > 0 end)
    t:wait(0.5 * s)
  end,

  demo = function(t, p)
    technique.lift(t.fundus)
    t.left:approach("gallbladder.infundibulum", { speed = 60 * mm / s, depth = 7 * mm })
    t.left:close()
    if p.demo == "expert" then expert(t) else technique.burn_wall(t.hook) end
  end,

  score = calot.score.weighted {
    { calot.score.rule(function(run)
      local torn = run.metrics["cystic_plate.torn_pct"] / 100
      return math.min(1, torn / rows), string.format("%.0f %% of the plane divided of %.0f", 100 * torn, 100 * rows),
        run:times("divided", "cystic_plate")
    end), name = "plane", weight = 0.4 },
    { calot.score.benchmark { metric = "total.bile_lost_mL", novice = 1, expert = 0 }, weight = 0.1 },
    { calot.score.benchmark { metric = "hook.activation_time_s", novice = 18, expert = 6 }, weight = 0.1 },
    { calot.score.benchmark { metric = "hook.path_length_mm", novice = 1500, expert = 600 }, weight = 0.1 },
    { calot.score.procedure {
      minor = { "slip", "dry_activation", "raw_surface" }, major = { "perforation", "overforce" },
    }, weight = 0.1 },
    { calot.score.rule(function(run)
      local looked = run:times("time_out")
      return #looked > 0 and 1 or 0, #looked > 0 and "the bed was looked at" or "nobody looked at the bed", looked
    end), name = "dry_look", weight = 0.1 },
    { calot.score.benchmark { metric = "liver.raw_mm2", novice = 100, expert = 5 }, weight = 0.1 },
    critical = { "overforce", "perforation" },
    cap = 40,
    pass = 80,
  },

  golden = { at = { 0, 4 * s, 8 * s, 10 * s, 13 * s, 16 * s, 20 * s, 24 * s, 28 * s, 38 * s } },
}
