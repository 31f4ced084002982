-- A first exercise: grasp the fundus and lift it. Change anything and play it again with `calot run`;
-- `calot check` finds mistakes without playing.
--
-- Everything is in SI units: write lengths as 20 * mm, angles as 30 * deg, forces as 2 * N.
-- The frame is the patient's: origin at the umbilicus, +x patient left, +y towards the head, +z out of the abdomen.

local calot = require "calot"
local mm, N, s, deg = calot.units.mm, calot.units.N, calot.units.s, calot.units.deg

return calot.exercise {
  api = 2,
  id = "starter-exercise",
  title = "Grasp the fundus and lift it",
  time_limit = 60 * s, -- the session ends then at the latest

  -- What can be chosen from outside: calot run FILE --param anatomy=hydrops
  params = {
    anatomy = { type = "choice", default = "standard", choices = { "standard", "hydrops" } },
  },

  -- The operating field at rest. `p` holds the chosen parameters.
  scene = function(p)
    return {
      anatomy = calot.anatomy(p.anatomy),
      laparoscope = { port = "umbilical", angle = 30 * deg, look_at = "gallbladder.fundus" },
      -- Instruments have a name of your choice; below they are t.left.
      instruments = { left = { type = "atraumatic_grasper", port = "right_subcostal", force_limit = 8 * N } },
    }
  end,

  -- `calot list` names all ports, landmarks, events and metrics; `calot list FILE` those of this exercise.

  -- What the trainee has to do, in order. wait_until and hold ask again after every simulated step.
  steps = function(t)
    t:step("grasp", "Grasp the fundus", { limit = 20 * s, hint = "Come down on it with open jaws" })
    t:wait_until(function() return t.left:holds("gallbladder") end)

    t:step("lift", "Lift with at least 0.3 N for 2 s", { limit = 20 * s })
    t:hold("tension", function() return t.left:force("jaws") > 0.3 * N end, 2 * s) -- not what leans on the shaft
    t:note("lifted_to", t.left:distance("gallbladder.neck") / mm, "mm") -- into the report, beside the metrics
  end,

  -- How an expert would do it; this plays when nobody else moves the instruments.
  demo = function(t)
    t.left:approach("gallbladder.fundus")
    t.left:close()
    t.left:move_by({ 0, 5 * mm, 10 * mm }, { speed = 10 * mm / s })
    t.left:wait(3 * s)
  end,

  -- Each part earns between nothing (novice) and all (expert) of its weight; the weights sum to 1.
  -- Metrics are named <instrument>.<metric>, <step>.time_s, <step>.<hold>.time_in_s;
  -- `calot list FILE` lists all that this exercise measures.
  score = calot.score.weighted {
    { calot.score.benchmark { metric = "lift.tension.time_in_s", novice = 0, expert = 2 }, weight = 0.5 },
    { calot.score.benchmark { metric = "left.path_length_mm", novice = 400, expert = 150 }, weight = 0.2 },
    { calot.score.penalty { event = "overforce", each = 0.5 }, weight = 0.3 },
    critical = { "overstretch" }, -- each of these caps the total and fails the exercise
    cap = 40,
    pass = 80,
  },

  -- When pictures are drawn; `calot golden accept` stores them to compare with later.
  golden = { at = { 0 * s, 3 * s } },
}
