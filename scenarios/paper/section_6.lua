-- The comparison of section 6 of Moutsopoulos and Gillies (1997): a coarse structure of 61 nodes with three structural
-- extensions against a uniform one of 245 nodes. Both are here, side by side, and pressed alike by three blunt tips
-- each. The paper found a mean error of 10 % of the largest displacement; the metric coarse.mean_difference_pct says
-- it of these two: below 5. (With extensions = false for the coarse one too it is above 20; two uniform meshes of 238
-- and 245 nodes are 3 apart.) What each costs is for calot bench to say.

local calot = require "calot"
local mm, s, kPa = calot.units.mm, calot.units.s, calot.units.kPa

local radius = 20 * mm
local centre = { coarse = { -72 * mm, 110 * mm, -100 * mm }, fine = { -24 * mm, 110 * mm, -100 * mm } }

-- Where the tips press and where they come from, as directions from a sphere's centre: the second from higher up, so
-- that its shaft passes over that of the other sphere's first.
local presses = {
  { at = { -0.62, 0.00, 0.78 }, from = { -0.25, 0.60, 0.76 } },
  { at = { 0.62, 0.00, 0.78 }, from = { 0.25, 0.52, 0.82 } },
  { at = { 0.00, -0.90, 0.44 }, from = { 0.00, -0.99, 0.10 } },
}
local reach, depth = 120 * mm, 8 * mm

local function from_centre(name, direction, distance)
  local point = {}
  for i = 1, 3 do
    point[i] = centre[name][i] + distance * direction[i]
  end
  return point
end

local function sphere(name, differs)
  local organ = {
    name = name,
    shape = { type = "sphere", radius = radius },
    neck = from_centre(name, { 0, 0, -1 }, radius),
    fundus = from_centre(name, { 0, 0, 1 }, radius),
    liver_side = { 1, 0, 0 },
    bile = { fill_pressure = 0.8 * kPa },
    -- Bedded softly all around: coarse and fine elements would see the edge of a smaller bed differently.
    held = { { name = "surroundings", landmark = "neck", radius = 45 * mm, stiffness = 3e5 } },
  }
  for key, value in pairs(differs) do
    organ[key] = value
  end
  return organ
end

local ports, instruments = { scope = { -50 * mm, -10 * mm, 5 * mm } }, {}
for _, name in ipairs { "coarse", "fine" } do
  for i, press in ipairs(presses) do
    local tool = name .. "_" .. i
    ports[tool] = from_centre(name, press.from, reach)
    instruments[tool] = { type = "bipolar_electrode", port = tool }
  end
end

return calot.exercise {
  api = 2,
  id = "paper-section-6",
  title = "61 nodes with three extensions beside 245 nodes",
  time_limit = 20 * s,

  scene = function()
    return {
      anatomy = {
        table_head_up = 0,
        table_left_down = 0,
        support = { point = { -48 * mm, 110 * mm, -120.6 * mm } },
        organs = {
          sphere("coarse", { nodes = 61, compared_with = "fine" }),
          sphere("fine", { nodes = 245, extensions = false }),
        },
      },
      ports = ports,
      instruments = instruments,
      solver = { rate = 25, extensions = { levels = 1 } },
      laparoscope = { port = "scope", look_at = "coarse.bed", distance = 74 * mm, show_structure = true },
    }
  end,

  steps = function(t)
    t:step("press", "Press both spheres alike", { limit = 10 * s })
    t:wait_until(function()
      for tool in pairs(instruments) do
        if not t[tool]:touching() then return false end
      end
      return true
    end)
    t:wait(1.5 * s)
  end,

  demo = function(t)
    local function press(name, i)
      return function()
        local tool, at = t[name .. "_" .. i], presses[i].at
        tool:move_to(from_centre(name, at, radius + 4 * mm), { speed = 60 * mm / s })
        tool:move_to(from_centre(name, at, radius - depth), { speed = 10 * mm / s })
      end
    end
    t:together(press("coarse", 1), press("coarse", 2), press("coarse", 3), press("fine", 1), press("fine", 2),
      press("fine", 3))
    t:wait(2 * s)
  end,

  golden = { at = { 0, 3.2 * s } },
}
