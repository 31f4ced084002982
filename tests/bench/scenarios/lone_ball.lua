-- A cost to measure: a ball of 61 nodes alone, pressed to and fro by three blunt tips, each with its extension.
local calot = require "calot"
local mm, s = calot.units.mm, calot.units.s

local radius, centre = 20 * mm, { -72 * mm, 110 * mm, -100 * mm }
local presses = {
  { at = { -0.62, 0.00, 0.78 }, from = { -0.25, 0.60, 0.76 } },
  { at = { 0.62, 0.00, 0.78 }, from = { 0.25, 0.60, 0.76 } },
  { at = { 0.00, -0.90, 0.44 }, from = { 0.00, -0.99, 0.10 } },
}

local function from_centre(direction, distance)
  local point = {}
  for i = 1, 3 do
    point[i] = centre[i] + distance * direction[i]
  end
  return point
end

local ports, instruments = { scope = { -50 * mm, -10 * mm, 5 * mm } }, {}
for i, press in ipairs(presses) do
  ports["tip_" .. i] = from_centre(press.from, 120 * mm)
  instruments["tip_" .. i] = { type = "bipolar_electrode", port = "tip_" .. i }
end

return calot.exercise {
  api = 1,
  id = "lone-ball",
  title = "Press a ball to and fro",
  time_limit = 60 * s,
  scene = function()
    return {
      anatomy = {
        organs = {
          {
            name = "ball",
            shape = { type = "sphere", radius = radius },
            nodes = 61,
            neck = from_centre({ 0, 0, -1 }, radius),
            fundus = from_centre({ 0, 0, 1 }, radius),
            held = { { name = "bed", landmark = "neck", radius = 15 * mm, stiffness = 1e6 } },
          },
        },
      },
      ports = ports,
      instruments = instruments,
      solver = { rate = 50, extensions = { levels = 1 } },
      laparoscope = { port = "scope", look_at = "ball.fundus" },
    }
  end,
  steps = function(t)
    t:step("press", "Press it", { limit = 40 * s })
    t:wait(8 * s)
  end,
  demo = function(t)
    local function press(i)
      return function()
        local tool, at = t["tip_" .. i], presses[i].at
        tool:move_to(from_centre(at, radius + 2 * mm), { speed = 60 * mm / s })
        for _ = 1, 4 do
          tool:move_to(from_centre(at, radius - 4 * mm), { speed = 15 * mm / s })
          tool:move_to(from_centre(at, radius), { speed = 15 * mm / s })
        end
      end
    end
    t:together(press(1), press(2), press(3))
  end,

  score = calot.score.weighted {
    { calot.score.benchmark { metric = "total.time_s", novice = 60, expert = 20 }, weight = 1 },
  },
}
