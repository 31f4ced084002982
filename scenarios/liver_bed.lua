-- The gallbladder comes off its bed: duct and artery are divided already, the fundus is pushed up over the liver's
-- edge, the pouch drawn up and aside, and between the two the hook opens the areolar plane from the neck on: in its
-- middle, as off it on one side there is bile, and on the other blood. So far it is the plane's first rows that this
-- exercise asks for. The mistakes are a parameter, demo = "clumsy": current on the gallbladder until its wall is open.

local calot = require "calot"
local anatomy = require "anatomy"
local technique = require "technique"
local mm, s, N, deg = calot.units.mm, calot.units.s, calot.units.N, calot.units.deg

local ports = {
  scope = { 0, 20 * mm, 10 * mm }, -- from the left one sees between gallbladder and liver
  epigastric = { -10 * mm, 120 * mm, -5 * mm },
}
local rows = 0.08 -- of the plane: its first rows
local firmly = 2 * N -- what the pouch is drawn with, so that the plane opens

-- Where the plane stands open: the strand nearest to the gallbladder's neck.
local function open_edge(t)
  local first
  for _, strand in ipairs(t:strands("cystic_plate")) do
    if not first or strand.share < first.share then first = strand end
  end
  return first.middle
end

local function expert(t)
  technique.free(t, t.hook, "cystic_plate", {
    port = ports.epigastric, hardest = 0.6 * N, between = { "liver", "gallbladder" },
    stretch = function(tension)
      if tension < 0.15 * N and t.left:force("jaws") < 3.2 * N then
        t.left:move_by({ -1 * mm, -0.8 * mm, 1.6 * mm }, { speed = 8 * mm / s })
      end
    end,
    is_done = function() return t:torn("cystic_plate") >= rows end,
  })
  t.hook:move_by({ 10 * mm, 0, 30 * mm }, { speed = 100 * mm / s })
  t:time_out("the bed is dry so far")
end

return calot.exercise {
  api = 2,
  id = "liver-bed",
  title = "Off the liver's bed: the plane's first rows",
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
        fundus = { port = "right_lateral", force_limit = 5 * N },
        left = { port = "right_subcostal", force_limit = 5 * N },
        hook = { type = "l_hook", port = "epigastric", force_limit = 3 * N, power = 30 },
      },
      laparoscope = { port = "scope", angle = 30 * deg, look_at = "gallbladder.infundibulum", distance = 90 * mm },
      solver = { motion = "dynamic", rate = 25 }, -- as critical_view.lua
    }
  end,

  steps = function(t)
    technique.lift_step(t)
    t:step("open", "Draw the pouch up and aside, until the plane behind it is under tension", {
      limit = 20 * s,
      hint = "Hartmann's pouch to the patient's right and towards you; look in from the left",
    })
    t:wait_until(function() return t.left:holds("gallbladder") and t.left:force("jaws") > firmly end)
    t:step("free", "Divide the plane's first rows with the hook, midway between gallbladder and liver", {
      limit = 100 * s,
      hint = "sweep the foot into taut strands and let current flow while it lies on them; draw the pouch on as it "
        .. "yields",
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
    t.left:approach("gallbladder.infundibulum", { speed = 60 * mm / s, depth = 3.5 * mm })
    t.left:close()
    t:together(function()
      t.left:move_by({ -8 * mm, -10 * mm, 15 * mm }, { speed = 8 * mm / s })
      t.left:move_by({ -10 * mm, 3 * mm, 8 * mm }, { speed = 8 * mm / s })
    end, function()
      t.laparoscope:look_at("gallbladder.neck", { distance = 75 * mm })
    end)
    t.laparoscope:look_at(open_edge(t), { distance = 75 * mm })
    if p.demo == "expert" then expert(t) else technique.burn_wall(t.hook) end
  end,

  score = calot.score.weighted {
    { calot.score.rule(function(run)
      local torn = run.metrics["cystic_plate.torn_pct"] / 100
      return math.min(1, torn / rows), string.format("%.0f %% of the plane divided of %.0f", 100 * torn, 100 * rows),
        run:times("divided", "cystic_plate")
    end), name = "plane", weight = 0.5 },
    { calot.score.benchmark { metric = "total.bile_lost_mL", novice = 1, expert = 0 }, weight = 0.1 },
    { calot.score.benchmark { metric = "hook.activation_time_s", novice = 20, expert = 6 }, weight = 0.1 },
    { calot.score.benchmark { metric = "hook.path_length_mm", novice = 2500, expert = 900 }, weight = 0.1 },
    { calot.score.procedure {
      minor = { "slip", "dry_activation" }, major = { "perforation", "overforce" },
    }, weight = 0.1 },
    { calot.score.rule(function(run)
      local looked = run:times("time_out")
      return #looked > 0 and 1 or 0, #looked > 0 and "the bed was looked at" or "nobody looked at the bed", looked
    end), name = "dry_look", weight = 0.1 },
    critical = { "overforce", "perforation" },
    cap = 40,
    pass = 80,
  },

  golden = { at = { 0, 4 * s, 8.6 * s, 11 * s, 17.2 * s, 24 * s, 28 * s, 32 * s, 40 * s, 45 * s } },
}
