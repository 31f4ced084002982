-- Calot's triangle exposed, the first act of the operation: one grasper takes the fundus and pushes it up over the
-- liver's edge; another draws the pouch to the side and downwards, so that the cystic duct stands off the common duct
-- and the laparoscope sees what lies between them. The classic mistake is a parameter, traction = "cephalad": both ends
-- pulled towards the head line the ducts up. A hydrops is tense: a needle through the wall of its fundus draws it slack
-- first, as surgeons do.

local calot = require "calot"
local anatomy = require "anatomy"
local technique = require "technique"
local mm, s, N, deg, mmHg = calot.units.mm, calot.units.s, calot.units.N, calot.units.deg, calot.units.mmHg

-- Where the fundus goes: towards the patient's right shoulder, over the liver.
local up = { -0.33, 0.6, 0.73 }
-- A gallbladder with less pressure than this is slack enough to be held.
local slack = 5 * mmHg

-- Jaws are opened as far as the fold needs.
local wide = 45 * deg

local function seen_mm2(t) return t:seen_area(technique.triangle(t)) / mm ^ 2 end
local function angle_deg(t) return technique.angle_of_ducts(t) / deg end

local function is_tense(p) return p.field == "hydrops" end

return calot.exercise {
  api = 2,
  id = "exposure",
  title = "Expose Calot's triangle",
  time_limit = 60 * s,

  params = {
    field = {
      type = "choice",
      default = "standard",
      choices = { "standard", "short_cystic_duct", "low_union", "double_cystic_artery", "hepatic_artery_near_neck",
        "hydrops", "phrygian_cap" },
      title = "the patient's anatomy",
    },
    traction = {
      type = "choice",
      default = "lateral",
      choices = { "lateral", "cephalad" },
      title = "how the demo draws the pouch: to the side, as an expert, or towards the head, the classic mistake",
    },
  },

  scene = function(p)
    local own = { assistant = false }
    local ports = { scope = { -40 * mm, 20 * mm, 10 * mm } }
    local instruments = {
      fundus = { port = "right_lateral", force_limit = 5 * N },
      left = { port = "right_subcostal", force_limit = 5 * N },
    }
    if is_tense(p) then
      ports.needle = { -100 * mm, 45 * mm, 0 }
      instruments.needle = { type = "aspiration_needle", port = "needle", force_limit = 3 * N }
    end
    return {
      anatomy = p.field == "standard" and anatomy.standard(own) or anatomy.variant(p.field, own),
      ports = ports,
      instruments = instruments,
      laparoscope = { port = "scope", angle = 0, look_at = "gallbladder.infundibulum", distance = 120 * mm },
      -- Hands that draw on tissue are slow: 50 steps a second give the same score to 0.2 %, peak forces to 4 %.
      solver = { motion = "dynamic", rate = 25, tolerance = 1e-5 },
    }
  end,

  steps = function(t, p)
    if is_tense(p) then
      t:step("decompress", "Draw the tense gallbladder slack through a needle", {
        limit = 15 * s,
        hint = "push the needle's tip on the fundus, straight at its wall, and let it draw until the wall gives way",
      })
      t:wait_until(function() return t:pressure("gallbladder") < slack end)
    end

    t:step("lift", "Take the fundus and push it up over the liver's edge", {
      limit = 20 * s,
      hint = "the fundus is the round end away from the ducts: close the jaws on a fold of it and push it towards the "
        .. "patient's right shoulder, until the gallbladder's underside is seen",
    })
    local hung = t:place("gallbladder.fundus")
    t:wait_until(function()
      local way = technique.minus(t:place("gallbladder.fundus"), hung)
      return t.fundus:holds("gallbladder") and technique.dot(way, up) > 15 * mm
    end)

    t:step("grasp", "Take the gallbladder by its pouch", {
      limit = 15 * s,
      hint = "Hartmann's pouch is the bulge before the neck: press on it with open jaws, and close them",
    })
    t:wait_until(function() return t.left:holds("gallbladder") end)

    t:step("expose", "Draw it so that the triangle between the ducts is seen, and keep it there", {
      limit = 15 * s,
      hint = "to the patient's right and down: the cystic duct should stand across the common duct, not along it; when "
        .. "you have it, hold still for 4 s",
    })
    local taken, seen, angle = t:place("gallbladder.infundibulum"), seen_mm2(t), angle_deg(t)
    local drawn = t:hold("drawn", function()
      local way = technique.minus(t:place("gallbladder.infundibulum"), taken)
      return t.fundus:holds("gallbladder") and t.left:holds("gallbladder") and technique.length(way) > 8 * mm
    end, 4 * s)
    if not drawn then return end
    t:note("triangle_seen_mm2", seen_mm2(t), "mm2")
    t:note("triangle_gained_mm2", seen_mm2(t) - seen, "mm2")
    t:note("angle_of_ducts_deg", angle_deg(t), "degrees")
    t:note("angle_gained_deg", angle_deg(t) - angle, "degrees")
  end,

  demo = function(t, p)
    if is_tense(p) then technique.draw_slack(t, t.needle, slack) end
    t.fundus:approach("gallbladder.fundus", { speed = 40 * mm / s, depth = 6 * mm, jaw = wide })
    t.fundus:close()
    t.fundus:move_by({ -9 * mm, 17 * mm, 20 * mm }, { speed = 8 * mm / s })
    t.left:approach("gallbladder.infundibulum", { speed = 40 * mm / s, depth = 4 * mm, jaw = wide })
    t.left:close()
    local way = p.traction == "lateral" and { -18 * mm, -11 * mm, 7 * mm } or { -4 * mm, 22 * mm, 8 * mm }
    t.left:move_by(way, { speed = 6 * mm / s })
    t.left:wait(2 * s)
  end,

  score = calot.score.weighted {
    -- Gained since the pouch was taken: an untouched field shows more of the triangle than a lifted one.
    { calot.score.benchmark { metric = "note.triangle_gained_mm2", novice = 0, expert = 60 }, weight = 0.4 },
    { calot.score.benchmark { metric = "note.angle_gained_deg", novice = 5, expert = 35 }, weight = 0.3 },
    { calot.score.benchmark { metric = "left.peak_jaws_force_N", novice = 5, expert = 3 }, weight = 0.2 },
    { calot.score.penalty { event = "slip", each = 0.5 }, weight = 0.1 },
    critical = { "overforce" },
    cap = 40,
    pass = 70,
  },

  golden = { at = { 0, 4.4 * s, 8.4 * s, 10.4 * s, 15.6 * s } },
}
