-- Grasp the fundus, lift the gallbladder, hold it within a force band, let go.
--
-- An exercise is a table: what the operating field is (scene), what is asked (steps), how an expert does it (demo),
-- what counts (score) and when pictures are compared (golden). Figures carry their unit: 70 * mm, 12 * mmHg.
-- Places are in the patient's frame: x to the patient's left, y towards the head, z out of the abdomen, in m from
-- the navel.

local calot = require "calot"
local mm, N, s, deg = calot.units.mm, calot.units.N, calot.units.s, calot.units.deg

local least, most = 1.5 * N, 3.0 * N -- the force band

return calot.exercise {
  api = 2,
  id = "grasp-and-traction",
  title = "Hold the fundus in a force band",
  time_limit = 120 * s,

  -- What can be chosen when the exercise is started: calot run ... --param anatomy=hydrops
  params = {
    anatomy = { type = "choice", default = "standard", choices = { "standard", "hydrops" } },
  },

  -- The operating field. p holds the chosen parameters.
  scene = function(p)
    return {
      anatomy = calot.anatomy(p.anatomy),
      solver = { motion = "dynamic", rate = 50, tolerance = 1e-6, extensions = { levels = 1 } },
      laparoscope = { port = "umbilical", angle = 30 * deg, look_at = "gallbladder.fundus" },
      instruments = {
        left = { type = "atraumatic_grasper", port = "right_subcostal", force_limit = 5 * N },
      },
    }
  end,

  -- What is asked. It reads like the operation: each wait lets the simulation run on. A step that reaches its
  -- limit ends as timed out, and the next begins.
  steps = function(t)
    t:step("grasp", "Grasp the fundus", { limit = 30 * s })
    t:wait_until(function() return t.left:holds("gallbladder") end)

    t:step("hold", "Lift it and hold 1.5 to 3 N for 10 s", {
      limit = 40 * s, force_on = "left", least = least, most = most,
    })
    t:hold("band", function()
      local force = t.left:force("jaws")
      return t.left:holds("gallbladder") and force > least and force < most
    end, 10 * s)
    t:note("pull", t.left:pull(), "N") -- along the shaft, at the end of the hold

    t:step("release", "Lower it and let go", { limit = 20 * s })
    local let_go = t:count("release") -- until now: to hold nothing is no letting go
    t:wait_until(function() return t:count("release") > let_go and not t.left:holds() end)
  end,

  -- How an expert does it, so that the exercise runs without anyone at the handles.
  demo = function(t)
    t.left:approach("gallbladder.fundus", { speed = 40 * mm / s })
    t.left:close()
    t.left:move_by({ 0, 3 * mm, 9 * mm }, { speed = 10 * mm / s })
    t.left:wait(12 * s)
    t.left:move_by({ 0, -3 * mm, -9 * mm }, { speed = 10 * mm / s })
    t.left:open()
    t.left:move_by({ 0, 0, 30 * mm })
  end,

  -- What counts. Weights sum to 1, the total is 0 to 100. Each part earns by the share of the steps that were done: of
  -- all, unless it names its own. Who has held for 7 s of 10 has not done "hold": the time in the band names "grasp".
  score = calot.score.weighted {
    { calot.score.benchmark { metric = "hold.band.time_in_s", novice = 2, expert = 10 }, weight = 0.4,
      steps = { "grasp" } },
    { calot.score.benchmark { metric = "left.path_length_mm", novice = 300, expert = 80 }, weight = 0.2 },
    { calot.score.benchmark { metric = "total.time_s", novice = 60, expert = 20 }, weight = 0.1 },
    { calot.score.penalty { event = "overforce", each = 0.5 }, weight = 0.3 },
    critical = { "overstretch" },
    cap = 40,
    pass = 80,
  },

  golden = { at = { 0, 1.4 * s, 6 * s } },
}
