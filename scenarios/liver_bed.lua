-- The gallbladder comes off its bed: duct and artery are divided already, the fundus is pushed up over the liver's
-- edge, and the body, rolled to the patient's right as one turns a page, opens the areolar plane behind it. From the
-- neck on the hook sweeps along the plane's front, in its middle, as off it on one side there is bile, and on the other
-- raw liver. So far it is the plane's first tenth that this exercise asks for. The mistakes are a parameter,
-- demo = "clumsy": current on the gallbladder until its wall is open.

local calot = require "calot"
local anatomy = require "anatomy"
local technique = require "technique"
local mm, s, N, deg = calot.units.mm, calot.units.s, calot.units.N, calot.units.deg

local ports = {
  scope = { 0, 20 * mm, 10 * mm }, -- from the left one sees between gallbladder and liver
  epigastric = { -10 * mm, 120 * mm, -5 * mm },
}
local rows = 0.1 -- of the plane: its first tenth
local firmly = 4.6 * N -- what the body is drawn with, so that the plane opens: more, and it turns in the jaws

-- Rolled to the patient's right the body opens the plane like a book; the camera follows the front.
local function roll(t, front)
  t:together(function()
    for _ = 1, 4 do
      if t.left:force("jaws") > firmly then break end
      t.left:move_by({ -2.4 * mm, 0, 0.6 * mm }, { speed = 15 * mm / s })
    end
  end, function()
    t.laparoscope:look_at(front.at, { distance = 75 * mm })
  end)
end

local function expert(t)
  technique.free(t, t.hook, "cystic_plate", {
    port = ports.epigastric, from = t:place("gallbladder.neck"), hardest = 0.6 * N,
    between = { "liver", "gallbladder" }, stretch = function(front) roll(t, front) end,
    is_done = function() return t:torn("cystic_plate") >= rows end,
  })
  t.hook:move_by({ 10 * mm, 0, 30 * mm }, { speed = 100 * mm / s })
  t:time_out("the bed is dry so far")
end

return calot.exercise {
  api = 2,
  id = "liver-bed",
  title = "Off the liver's bed: the plane's first tenth",
  time_limit = 150 * s,

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
        without = {
          "cystic_node", "hilar_fat", "triangle_fat", "artery_fat", "cystic_artery", "cystic_duct",
          "right_hepatic_artery",
        },
      },
      ports = ports,
      instruments = {
        fundus = { port = "right_lateral", force_limit = 5 * N, pinch_force = 12 * N }, -- above 15 N it would harm
        left = { port = "right_subcostal", force_limit = 8 * N, pinch_force = 12 * N },
        hook = { type = "l_hook", port = "epigastric", force_limit = 3 * N, power = 30 },
      },
      laparoscope = { port = "scope", angle = 30 * deg, look_at = "gallbladder.infundibulum", distance = 90 * mm },
      solver = { motion = "dynamic", rate = 25 }, -- as critical_view.lua
    }
  end,

  steps = function(t)
    technique.lift_step(t)
    t:step("open", "Take the body and roll it, until the plane behind it is under tension", {
      limit = 20 * s,
      hint = "draw the gallbladder's body to the patient's right, as one turns a page; look in from the left",
    })
    t:wait_until(function() return t.left:holds("gallbladder") and t.left:force("jaws") > 2 * N end)
    t:step("free", "Divide the plane's first tenth with the hook, midway between gallbladder and liver", {
      limit = 100 * s,
      hint = "sweep the foot along the taut strands and let current flow while it lies on them; roll the body on as "
        .. "they yield",
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
    t.left:approach("gallbladder.body", { speed = 60 * mm / s, depth = 5 * mm })
    t.left:close()
    t:together(function()
      t.left:move_by({ -16 * mm, 0, 4 * mm }, { speed = 15 * mm / s })
    end, function()
      t.laparoscope:look_at("gallbladder.neck", { distance = 75 * mm })
    end)
    if p.demo == "expert" then expert(t) else technique.burn_wall(t.hook) end
  end,

  score = calot.score.weighted {
    { calot.score.rule(function(run)
      local torn = run.metrics["cystic_plate.torn_pct"] / 100
      return math.min(1, torn / rows), string.format("%.0f %% of the plane divided of %.0f", 100 * torn, 100 * rows),
        run:times("divided", "cystic_plate")
    end), name = "plane", weight = 0.5 },
    { calot.score.benchmark { metric = "total.bile_lost_mL", novice = 1, expert = 0 }, weight = 0.1 },
    { calot.score.benchmark { metric = "hook.activation_time_s", novice = 15, expert = 5 }, weight = 0.1 },
    { calot.score.benchmark { metric = "hook.path_length_mm", novice = 1200, expert = 400 }, weight = 0.1 },
    { calot.score.procedure {
      minor = { "slip", "dry_activation", "raw_surface" }, major = { "perforation", "overforce" },
    }, weight = 0.1 },
    { calot.score.rule(function(run)
      local looked = run:times("time_out")
      return #looked > 0 and 1 or 0, #looked > 0 and "the bed was looked at" or "nobody looked at the bed", looked
    end), name = "dry_look", weight = 0.1 },
    critical = { "overforce", "perforation" },
    cap = 40,
    pass = 80,
  },

  golden = { at = { 0, 4 * s, 8.6 * s, 11 * s, 14 * s, 17 * s, 20 * s, 24 * s, 28 * s, 31 * s } },
}
