-- The gallbladder comes off its bed from the fundus on, while cystic duct and artery stand: the way out where Calot's
-- triangle cannot be dissected safely. The whole plane stands at first, and nobody touches the triangle. The fundus is
-- taken and swung to the patient's right and down, so that the plane's left side stands open under tension. The
-- laparoscope looks along it from the left and above, the hook comes from the left. It sweeps through what the
-- laparoscope sees at fundus and body. Then the fundus is rolled on beneath the liver's right side: the bed turns to
-- the front, and the hook takes the body's left side, and the fundus up to its right border. When the fundus is free
-- the operator says that duct and artery stand. The mistakes are a parameter, demo = "clumsy": current on the
-- gallbladder until its wall is open.

local calot = require "calot"
local anatomy = require "anatomy"
local technique = require "technique"
local mm, s, N, deg = calot.units.mm, calot.units.s, calot.units.N, calot.units.deg

local ports = {
  scope = { 10 * mm, 120 * mm, 0 }, -- left of the epigastric one: from there one sees along the plane
  left_lower = { 80 * mm, 34 * mm, -5 * mm }, -- off what is swung to the right
}
local fundus, asked, half = 0.6, 0.95, 0.5 -- the fundus begins at that share of the way from neck to fundus
local aside = { -0.85, 0.17, -0.5 } -- to the patient's right and down into the flank
local rolled = { -0.34, 0.43, -1 } -- on beneath the liver's right side: the gallbladder's bed turns to the front

-- How many strands of the plane stand at the fundus.
local function at_fundus(t)
  local count = 0
  for _, strand in ipairs(t:strands("cystic_plate")) do
    if strand.share > fundus then count = count + 1 end
  end
  return count
end

-- The hand that draws the fundus that way while the hook divides the plane.
local function drawing_hand(t, along, firmly)
  return technique.drawing_hand(t, t.fundus, "cystic_plate",
    { along = along, firmly = firmly, least = 3 * N, most = 6 * N, distance = 60 * mm })
end

local function expert(t)
  local left = (1 - asked) * at_fundus(t)
  local function swing(along, firmly)
    t.fundus:move_until(function() return t.fundus:force("jaws") > firmly end,
      { along = along, speed = 25 * mm / s, limit = 60 * mm })
    t.laparoscope:look_at("gallbladder.bed", { distance = 60 * mm })
  end
  -- Takes what is seen of the plane beyond a share of the way from neck to fundus.
  local function free_until(is_done, from, beyond, draw, ease)
    technique.free(t, t.hook, "cystic_plate", {
      port = ports.left_lower, from = t:place(from), hardest = 0.6 * N,
      between = { "liver", "gallbladder" }, stretch = draw, ease = ease,
      wanted = function(strand) return strand.share > beyond and t:sees(strand.middle) end,
      is_done = is_done,
    })
  end
  swing(aside, 4 * N)
  free_until(function() return t:torn("cystic_plate") >= 0.25 end, "gallbladder.fundus", 0.55,
    drawing_hand(t, aside, 4.4 * N))
  swing(rolled, 4.5 * N)
  free_until(function() return t:torn("cystic_plate") >= 0.52 end, "gallbladder.bed", 0.38,
    drawing_hand(t, rolled, 4.9 * N)) -- the body's left side too: else it would carry the pull
  free_until(function() return at_fundus(t) <= left end, "gallbladder.fundus", 0.6, drawing_hand(t, rolled, 5.4 * N))
  technique.withdraw(t.hook, ports.left_lower)
  t.laparoscope:look_at("gallbladder.bed", { distance = 70 * mm })
  t:wait(1 * s)
  t:time_out("the fundus is free; duct and artery stand")
end

-- How much of the plane at the fundus was divided, beside the share that is asked for.
local function judge_fundus(run)
  local free = (run.notes.fundus_free_pct or 0) / 100
  return math.min(1, free / asked), string.format("%.0f %% of the plane at the fundus divided", 100 * free),
    run:times("divided", "cystic_plate")
end

return calot.exercise {
  api = 2,
  id = "fundus-first",
  title = "Fundus first: the fundus comes off the liver while duct and artery stand",
  time_limit = 300 * s,

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
      anatomy = anatomy.standard { assistant = false, areolar_plane = true },
      ports = ports,
      instruments = {
        fundus = { port = "right_subcostal", force_limit = 8 * N, pinch_force = 12 * N }, -- above 15 N it would harm
        hook = { type = "l_hook", port = "left_lower", force_limit = 3 * N, power = 30 },
      },
      laparoscope = {
        port = "scope", angle = 30 * deg, look_at = "gallbladder.fundus", distance = 80 * mm,
        exposure = 2.5, -- what is far behind is dark
      },
      solver = { motion = "dynamic", rate = 25 }, -- as critical_view.lua
    }
  end,

  steps = function(t)
    local stood, noted = at_fundus(t), -1
    -- The share of the fundus that is free; noted from tenth to tenth, and when it is what is asked for.
    local function free_share()
      local share = (stood - at_fundus(t)) / math.max(1, stood)
      if share - noted >= 0.1 or noted < asked and share >= asked then
        t:note("fundus_free_pct", 100 * share, "%")
        noted = share
      end
      return share
    end
    t:step("open", "Take the fundus and swing it to the patient's right, until the plane's left side is taut", {
      limit = 20 * s,
      hint = "close the jaws on a fold of the fundus; draw it to the right and down into the flank, off the liver",
    })
    t:wait_until(function() return t.fundus:holds("gallbladder") and t.fundus:force("jaws") > 2 * N end)
    t:step("free", "Divide the plane at the fundus, midway between gallbladder and liver", {
      limit = 230 * s,
      hint = "sweep the foot along the taut strands that you see, and let current flow while it lies on them; draw the "
        .. "fundus on as they yield, then roll it under the liver's right side; keep off the triangle",
    })
    t:wait_until(function() return free_share() >= asked and t:torn("cystic_plate") >= half end)
    t:step("look", "Say that duct and artery stand", { limit = 20 * s, hint = "hook out of the way, then a time-out" })
    t:wait_until(function() return t:count("time_out") > 0 end)
  end,

  demo = function(t, p)
    t.fundus:approach("gallbladder.fundus", { speed = 60 * mm / s, depth = 6 * mm })
    t.fundus:close()
    if p.demo == "expert" then expert(t) else technique.burn_wall(t.hook) end
  end,

  score = calot.score.weighted {
    { calot.score.rule(judge_fundus), name = "fundus", weight = 0.3 },
    { calot.score.rule(function(run) return technique.judge_plane(run, "cystic_plate", half) end), name = "plane",
      weight = 0.1 },
    { calot.score.rule(function(run)
      local hurt = run:count("cut") + run:count("injury") + run:count("tear", "triangle_fat")
      return hurt == 0 and 1 or 0, hurt == 0 and "duct, artery and triangle are whole" or "the triangle was entered"
    end), name = "triangle", weight = 0.2 },
    { calot.score.benchmark { metric = "total.bile_lost_mL", novice = 1, expert = 0 }, weight = 0.1 },
    { calot.score.benchmark { metric = "hook.activation_time_s", novice = 60, expert = 20 }, weight = 0.1 },
    { calot.score.procedure {
      minor = { "slip", "dry_activation", "raw_surface" }, major = { "perforation", "overforce" },
    }, weight = 0.1 },
    { calot.score.benchmark { metric = "liver.raw_mm2", novice = 100, expert = 5 }, weight = 0.1 },
    critical = { "overforce", "perforation" },
    cap = 40,
    pass = 80,
  },
}
