-- The gallbladder comes off its bed: duct and artery are divided already, and the plate's lower third is, as the
-- critical view asks for it. The fundus is pushed up over the liver's edge, the pouch is lifted and drawn over it, too,
-- so that the gallbladder is turned over and the areolar plane behind it stands open under tension: from here on the
-- pouch carries it alone. The hook sweeps through the plane from the neck on, in its middle, as off it on one side
-- there is bile, and on the other raw liver. At a half the bed is looked at, as bleeding is hard to find once nothing
-- holds the liver up, and what is left comes off fast. Then the gallbladder is free, and is laid on the omentum. The
-- mistakes are a parameter, demo = "clumsy": current on the gallbladder until its wall is open.

local calot = require "calot"
local anatomy = require "anatomy"
local technique = require "technique"
local mm, s, N, deg = calot.units.mm, calot.units.s, calot.units.N, calot.units.deg

local ports = {
  scope = { 0, 20 * mm, 10 * mm }, -- from the left one sees between gallbladder and liver
  left_upper = { 80 * mm, 80 * mm, -5 * mm }, -- as where one stands between the legs: below what is turned over
}
local half = 0.5 -- of the plane: what stands then is left until the bed has been looked at
local over_the_edge = { -0.15, 0.9, 0.4 }

-- The hand turns its shaft with the pouch as that is turned over: else it turns between the jaws.
local function turn_with_it(hand)
  for _ = 1, 12 do
    local torque = hand:torque()
    if math.abs(torque) < 8e-3 then return end
    hand:rotate(torque > 0 and 8 * deg or -8 * deg, { speed = 100 * deg / s })
  end
end

-- The hand that draws the pouch over the liver's edge while the hook divides the plane.
local function drawing_hand(t, firmly)
  return technique.drawing_hand(t, t.left, "cystic_plate", {
    along = over_the_edge, firmly = firmly, least = 1.6 * N, most = 5 * N, distance = 75 * mm,
    follow = function() turn_with_it(t.left) end,
  })
end

-- Lets go and draws back out of the way.
local function let_go(hand)
  hand:open()
  hand:move_by({ -15 * mm, -15 * mm, 30 * mm }, { speed = 60 * mm / s })
end

-- Lowers what the jaws carry until it touches and something else carries some of it, then on to the side, so that it
-- lies down along the way.
local function lay_down(hand)
  local carried, lowered = hand:force("jaws"), 0
  while lowered < 60 * mm and math.abs(hand:force("jaws") - carried) < 0.03 * carried do
    hand:move_by({ 0, 0, -4 * mm }, { speed = 40 * mm / s })
    lowered = lowered + 4 * mm
  end
  hand:move_by({ 40 * mm, 0, -20 * mm }, { speed = 40 * mm / s })
end

local function expert(t)
  t.left:move_by({ 0, 9 * mm, 42 * mm }, { speed = 30 * mm / s }) -- off the liver
  t:together(function()
    t.left:move_by({ -4 * mm, 28 * mm, 12 * mm }, { speed = 25 * mm / s }) -- and over its edge
  end, function()
    t.laparoscope:look_at("gallbladder.body", { distance = 75 * mm })
  end)
  let_go(t.fundus) -- the pouch carries it from here on
  local function free_until(torn, draw, ease)
    technique.free(t, t.hook, "cystic_plate", {
      port = ports.left_upper, from = t:place("liver.underside"), hardest = 0.6 * N,
      between = { "liver", "gallbladder" }, stretch = draw, ease = ease,
      is_done = function() return t:torn("cystic_plate") >= torn end,
    })
    technique.withdraw(t.hook, ports.left_upper)
  end
  free_until(half, (drawing_hand(t, 3 * N)))
  t.laparoscope:look_at("liver.underside", { distance = 60 * mm })
  t:wait(2 * s) -- what bleeds or leaks is seen by then
  t:time_out("the bed is dry")
  free_until(1, drawing_hand(t, math.max(2 * N, t.left:force("jaws"))))
  t:together(function()
    t.left:move_to({ -60 * mm, 120 * mm, 0 }, { speed = 60 * mm / s }) -- across before the liver
    t.left:move_to({ 70 * mm, 138 * mm, -30 * mm }, { speed = 60 * mm / s })
  end, function()
    t.laparoscope:look_at({ 65 * mm, 115 * mm, -140 * mm }, { distance = 120 * mm })
  end)
  lay_down(t.left)
  let_go(t.left)
end

return calot.exercise {
  api = 2,
  id = "liver-bed",
  title = "Off the liver's bed: the gallbladder is freed and laid aside",
  time_limit = 360 * s,

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
        prepared = {
          cystic_plate = 1 / 3, -- its lower third: else there was no critical view
          cystic_duct = 0.4, cystic_artery = { 0.5, 1 }, -- divided: what stays with the patient
        },
        without = { "cystic_node", "hilar_fat", "triangle_fat", "artery_fat" },
      },
      ports = ports,
      instruments = {
        fundus = { port = "right_lateral", force_limit = 8 * N, pinch_force = 12 * N }, -- above 15 N it would harm
        left = { port = "right_subcostal", force_limit = 8 * N, pinch_force = 12 * N },
        hook = { type = "l_hook", port = "left_upper", force_limit = 3 * N, power = 30 },
      },
      laparoscope = { port = "scope", angle = 30 * deg, look_at = "gallbladder.infundibulum", distance = 90 * mm },
      solver = { motion = "dynamic", rate = 25 }, -- as critical_view.lua
    }
  end,

  steps = function(t)
    for _, share in ipairs { 0.1, 0.3 } do
      t:clip("cystic_duct", share)
      t:clip("cystic_artery", 1 - share)
    end
    technique.lift_step(t)
    t:step("open", "Take the pouch and draw it over the liver's edge, until the plane behind is under tension", {
      limit = 20 * s,
      hint = "lift it off the liver, then turn it over: towards the patient's right shoulder; look in from below",
    })
    t:wait_until(function() return t.left:holds("gallbladder") and t.left:force("jaws") > 2 * N end)
    t:step("free", "Divide half of the plane, midway between gallbladder and liver", {
      limit = 240 * s,
      hint = "sweep the foot along the taut strands and let current flow while it lies on them; let the fundus go, "
        .. "draw the pouch on as they yield, and turn the shaft with it",
    })
    t:wait_until(function() return t:torn("cystic_plate") >= half end)
    t:step("look", "Look whether the bed is dry while the other half holds the liver up, and say so", {
      limit = 20 * s,
      hint = "hook out of the way, then a time-out",
    })
    t:wait_until(function() return t:count("time_out") > 0 end)
    t:step("last", "Divide the rest of the plane", { limit = 60 * s, hint = "draw less: little holds the liver now" })
    t:wait_until(function() return t:torn("cystic_plate") == 1 end)
    t:step("lay", "Lay the gallbladder on the omentum, on the patient's left, and let it go", {
      limit = 30 * s,
      hint = "carry it across below the liver; open the jaws when it lies",
    })
    t:wait_until(function()
      return not t.left:holds() and not t.fundus:holds() and t:place("gallbladder.body")[1] > 0
    end)
    t:wait(1 * s)
  end,

  demo = function(t, p)
    technique.lift(t.fundus)
    t.left:approach("gallbladder.infundibulum", { speed = 60 * mm / s, depth = 7 * mm })
    t.left:close()
    if p.demo == "expert" then expert(t) else technique.burn_wall(t.hook) end
  end,

  score = calot.score.weighted {
    { calot.score.rule(function(run) return technique.judge_plane(run, "cystic_plate", 1) end), name = "plane",
      weight = 0.4 },
    { calot.score.benchmark { metric = "total.bile_lost_mL", novice = 1, expert = 0 }, weight = 0.1 },
    { calot.score.benchmark { metric = "hook.activation_time_s", novice = 60, expert = 20 }, weight = 0.1 },
    { calot.score.benchmark { metric = "hook.path_length_mm", novice = 3000, expert = 1200 }, weight = 0.1 },
    { calot.score.procedure {
      minor = { "slip", "dry_activation", "raw_surface" }, major = { "perforation", "overforce" },
    }, weight = 0.1 },
    { calot.score.rule(function(run)
      local looked, parted = run:times("time_out"), run:times("parted", "cystic_plate")
      if #looked == 0 then return 0, "nobody looked at the bed" end
      if #parted > 0 and parted[1] < looked[1] then return 0, "it was looked at when nothing held it up", looked end
      return 1, "the bed was looked at", looked
    end), name = "dry_look", weight = 0.1 },
    { calot.score.benchmark { metric = "liver.raw_mm2", novice = 100, expert = 5 }, weight = 0.1 },
    critical = { "overforce", "perforation" },
    cap = 40,
    pass = 80,
  },

  golden = {
    at = { 0 },
    moments = {
      { name = "fundus_lifted", step = "open", delay = 0.32 * s },
      { name = "pouch_taken", step = "open", event = "grasp", delay = 0.28 * s },
      { name = "drawn_over_the_edge", step = "free", delay = 1.64 * s },
      { name = "fundus_let_go", event = "release", delay = 1.92 * s },
      { name = "first_strands", event = "divided", organ = "cystic_plate", delay = 0.88 * s },
      { name = "front_is_open", step = "free", delay = 15.64 * s },
      { name = "sweeps_through", step = "free", delay = 41.64 * s },
      { name = "further_in", step = "free", delay = 51.64 * s },
      { name = "half_is_off", step = "look" },
      { name = "bed_looked_at", step = "last", delay = 0.08 * s },
      { name = "to_the_rest", step = "last", delay = 2.08 * s },
      { name = "last_strands", step = "last", delay = 10.08 * s },
      { name = "carried", step = "lay", delay = 2.72 * s },
      { name = "lowered", step = "lay", delay = 8.72 * s },
      { name = "laid_down", step = "lay", delay = 11.72 * s },
      { name = "let_go", step = "lay", event = "release", delay = 0.96 * s },
    },
  },
}
