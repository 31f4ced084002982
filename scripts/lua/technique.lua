-- What several exercises share: a step; what demos do with their hands, such as strands taken with the hook, clips set
-- and tubes cut; and small sums with points, { x, y, z } in the patient's frame.

local calot = require "calot"
local given = require "given"
local mm, s, deg, N = calot.units.mm, calot.units.s, calot.units.deg, calot.units.N

local technique = given.module "technique"

-- ---- points

function technique.plus(a, b, share)
  share = share or 1
  return { a[1] + share * b[1], a[2] + share * b[2], a[3] + share * b[3] }
end
function technique.minus(a, b) return technique.plus(a, b, -1) end
function technique.dot(a, b) return a[1] * b[1] + a[2] * b[2] + a[3] * b[3] end
function technique.length(a) return math.sqrt(technique.dot(a, a)) end
function technique.unit(a) return technique.plus({ 0, 0, 0 }, a, 1 / technique.length(a)) end

local plus, minus, dot, length, unit =
  technique.plus, technique.minus, technique.dot, technique.length, technique.unit
local function times(a, share) return plus({ 0, 0, 0 }, a, share) end
local function cross(a, b)
  return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
end

-- ---- exposure

--- Calot's triangle: the gallbladder's neck, where cystic and common duct meet, and where the common duct leaves the
--- liver.
function technique.triangle(t)
  return t:place("cystic_duct.start"), t:place("cystic_duct.end"), t:place("common_duct.start")
end

--- At the union, between the cystic duct and the common hepatic duct, rad.
function technique.angle_of_ducts(t)
  local neck, union, hilum = technique.triangle(t)
  return math.acos(dot(unit(minus(neck, union)), unit(minus(hilum, union))))
end

--- A step of an operation: the instrument `fundus` takes the gallbladder's fundus and pushes it up over the liver's
--- edge, towards the patient's right shoulder, by 15 mm at least.
function technique.lift_step(t)
  local up = { -0.33, 0.6, 0.73 }
  t:step("lift", "Take the fundus and push it up over the liver's edge", {
    limit = 20 * s,
    hint = "close the jaws on a fold of the fundus and push it towards the patient's right shoulder",
  })
  local hung = t:place("gallbladder.fundus")
  t:wait_until(function()
    return t.fundus:holds("gallbladder") and dot(minus(t:place("gallbladder.fundus"), hung), up) > 15 * mm
  end)
end

--- The hand that does so.
function technique.lift(grasper)
  grasper:approach("gallbladder.fundus", { speed = 60 * mm / s, depth = 6 * mm })
  grasper:close()
  grasper:move_by({ -6.5 * mm, 12.3 * mm, 14.5 * mm }, { speed = 8 * mm / s })
end

-- ---- the needle

--- Draws the gallbladder out through the wall of its fundus, until its pressure is below `slack`, and leaves it.
function technique.draw_slack(t, needle, slack)
  local outside = needle:tip()
  needle:approach("gallbladder.fundus", { speed = 60 * mm / s, depth = 3 * mm, offset = { 8 * mm, -8 * mm, 2 * mm } })
  for _ = 1, 60 do
    if t:pressure("gallbladder") < slack then break end
    needle:aspirate(0.2 * s)
  end
  needle:move_to(outside, { speed = 80 * mm / s })
end

-- ---- the hook

local function nearest_strand(t, hook, tissue, wanted)
  local tip, best = hook:tip(), nil
  for _, strand in ipairs(t:strands(tissue)) do
    local far = length(minus(strand.middle, tip))
    if wanted(strand) and (not best or far < best.far) then
      best = { far = far, middle = strand.middle, from = strand.from, to = strand.to }
    end
  end
  return best
end

--- Draws the hook out along its shaft, before it goes elsewhere. What hangs on it then comes off over its tip: down
--- again, towards its heel, and out.
local function draw_out(hook, back)
  local way, hangs = 15 * mm, 0.1 * N
  hook:move_by(times(back, way), { speed = 80 * mm / s })
  if hook:force() < hangs then return end
  hook:move_by(times(back, -way - 3 * mm), { speed = 80 * mm / s })
  hook:move_by({ 8 * mm, 0, 0 }, { speed = 40 * mm / s })
  hook:move_by(times(back, way + 3 * mm), { speed = 80 * mm / s })
end

--- A mistake: current on the gallbladder's wall beside its neck, until it is open; then the hook leaves.
function technique.burn_wall(hook)
  hook:approach("gallbladder.neck", { speed = 60 * mm / s, depth = 2 * mm, offset = { -8 * mm, -2 * mm, 3 * mm } })
  hook:activate(1 * s)
  hook:move_by({ 10 * mm, 20 * mm, 60 * mm }, { speed = 100 * mm / s })
end

local how_to_take = {
  port = given.three, tries = given.whole, hardest = given.above_zero, wanted = given.optional(given.called),
  is_done = given.optional(given.called), keep_off = given.optional(given.by_name),
}
local where_to_keep_off = { organ = given.name, place = given.three, clear = given.above_zero }

--- Strand by strand: the hook's foot, which points to the patient's right, comes down on the nearest one and draws
--- back off the walls that it lies on too, as they would be burnt. Current flows until one strand has parted; else the
--- foot comes down nearer to either end of it, as what a slack strand hangs on may keep the hook off its middle, and
--- then on all three nearer to its heel. Before a longer way it is drawn out. `how`: port, where its shaft comes from;
--- tries, of a tenth of a second; hardest, the force that ends its way down; wanted(strand), if given, those that are
--- taken; is_done(), if given, asked before each strand; keep_off, an organ and a place of it: current flows no nearer
--- to the organ than `clear`, and beside the place the heel comes down first, on the middle, and the foot points away.
function technique.take(t, hook, tissue, how)
  given.check(how, how_to_take, "technique.take", 2)
  if how.keep_off then given.check(how.keep_off, where_to_keep_off, "keep_off", 2) end
  local reach, by_heel = { 4 * mm, 2 * mm, 0.5 * mm }, { 0.7 * mm, -0.5 * mm, -1.5 * mm }
  local wanted = how.wanted or function() return true end
  local missed = 0
  while missed < 9 and not (how.is_done and how.is_done()) do
    local strand = nearest_strand(t, hook, tissue, wanted)
    if not strand then return end
    local off = how.keep_off
    local beside = off and length(minus(strand.middle, off.place)) < 10 * mm
    local ends = { strand.middle, strand.to, strand.from }
    local at = beside and strand.middle or plus(strand.middle, minus(ends[missed % 3 + 1], strand.middle), 0.5)
    local aim = plus(at, { beside and by_heel[missed % 3 + 1] or reach[missed // 3 + 1], 0, 0 })
    local back = unit(minus(how.port, at))
    if length(minus(aim, hook:tip())) > 12 * mm then draw_out(hook, back) end
    hook:move_to(plus(aim, back, 5 * mm), { speed = 80 * mm / s })
    local function lies_on_it()
      local contact = hook:contact()
      return contact ~= nil and contact.organ == tissue or hook:force() > how.hardest
    end
    local function may_burn()
      return hook:touching() and not (off and hook:clearance(off.organ) < off.clear)
    end
    hook:move_until(lies_on_it, { along = times(back, -1), speed = 25 * mm / s, limit = 8 * mm })
    hook:move_until(function()
      local contact = hook:contact()
      return contact == nil or contact.organ == tissue
    end, { along = back, speed = 5 * mm / s, limit = 2 * mm })
    local standing = #t:strands(tissue)
    for _ = 1, how.tries do
      if not may_burn() or #t:strands(tissue) < standing then break end
      hook:activate(0.1 * s)
    end
    missed = #t:strands(tissue) < standing and 0 or missed + 1
    hook:move_by(times(back, 5 * mm), { speed = 80 * mm / s })
  end
end

-- ---- the plane between two organs

local function across(a, normal) return plus(a, normal, -dot(a, normal)) end

--- Where x and y of an instrument's own frame point for a shaft from a port to a place, not turned.
local function frame_of(port, at)
  local shaft = unit(minus(at, port))
  local pitch, yaw = math.atan(shaft[2], -shaft[3]), math.asin(shaft[1])
  return { math.cos(yaw), -math.sin(pitch) * math.sin(yaw), math.cos(pitch) * math.sin(yaw) },
    { 0, -math.cos(pitch), -math.sin(pitch) }
end

--- The strands that stand, and those of them that are under tension, the tautest first.
local function taut_strands(t, tissue, slack)
  local all, taut = t:strands(tissue), {}
  for _, strand in ipairs(all) do
    if strand.tension > slack then taut[#taut + 1] = strand end
  end
  table.sort(taut, function(a, b) return a.tension > b.tension end)
  return all, taut
end

--- Which way leads from a strand into those that stand around it, in the plane: from the open side inward.
local function inward(strand, all, axis)
  local near, centre, count = 9 * mm, { 0, 0, 0 }, 0
  for _, other in ipairs(all) do
    if length(minus(other.middle, strand.middle)) < near then centre, count = plus(centre, other.middle), count + 1 end
  end
  local way = across(minus(times(centre, 1 / count), strand.middle), axis)
  return length(way) > 0.5 * mm and unit(way) or nil
end

--- A stroke along `way` in the plane's middle: current flows wherever the foot lies on the tissue. It ends after 12 mm,
--- or where the foot meets more than `hardest`, or the whole hook 2 N. `axis`: from the one organ to the other.
local function stroke(hook, tissue, how, way, axis)
  local others, long = how.between, 12 * mm
  for _ = 1, 20 do
    if how.is_done and how.is_done() then return end
    local contact = hook:contact("tip")
    local on_it = contact ~= nil and contact.organ == tissue
    if on_it then hook:activate(0.12 * s) end
    local aside = 0.5 * (hook:clearance(others[1]) - hook:clearance(others[2]))
    aside = math.max(-0.5 * mm, math.min(0.5 * mm, aside))
    local step = plus(times(way, on_it and 0.5 * mm or 1.5 * mm), axis, -aside)
    local _, gone = hook:move_until(function()
      local met = hook:contact("tip")
      return hook:force("tip") > how.hardest or hook:force() > 2 * N
        or not on_it and met ~= nil and met.organ == tissue
    end, { along = step, speed = 25 * mm / s, limit = length(step) })
    long = long - gone
    if long < 0 or not on_it and gone < 0.05 * mm then return end
  end
end

local how_to_free = {
  port = given.three, hardest = given.above_zero, between = given.names, stretch = given.optional(given.called),
  is_done = given.optional(given.called),
}

--- Takes a tissue off by strokes of the hook, where it is under tension: the foot, turned across strands and way,
--- sweeps from the open side into those that stand, midway between the two organs, and current flows while it lies on
--- them. It stops when nothing is under tension, or ten strokes in a row divide nothing. `how`: port, where the shaft
--- comes from; hardest, the force on its foot that ends a stroke; between, the two organs, first the one that the
--- tissue hangs on; stretch(tension), if given, called before each stroke with the tautest strand's tension, N, to
--- keep the plane under tension; is_done(), if given.
function technique.free(t, hook, tissue, how)
  given.check(how, how_to_free, "technique.free", 2)
  local slack, missed, rolled = 10e-3 * N, 0, 0
  while missed < 10 and not (how.is_done and how.is_done()) do
    local torn = t:torn(tissue)
    local all, taut = taut_strands(t, tissue, slack)
    if #taut == 0 then return end
    if how.stretch then how.stretch(taut[1].tension) end
    local strand = taut[1 + missed % #taut]
    local axis, back = unit(minus(strand.from, strand.to)), unit(minus(how.port, strand.middle))
    local way = inward(strand, all, axis)
    if way then
      local foot = unit(across(cross(way, axis), back))
      local x, y = frame_of(how.port, strand.middle)
      local turned = math.atan(dot(y, foot), dot(x, foot))
      local turn = turned - rolled
      local half_turns = math.floor(turn / math.pi + 0.5) -- the foot may point either way across
      turn = turn - math.pi * half_turns
      if half_turns % 2 ~= 0 then foot = times(foot, -1) end
      if math.abs(turn) > 25 * deg then
        hook:rotate(turn, { speed = 400 * deg / s })
        rolled = rolled + turn
      end
      local heel = plus(strand.middle, foot, -2.5 * mm)
      hook:move_to(plus(plus(heel, back, 14 * mm), way, -5 * mm), { speed = 100 * mm / s })
      hook:move_to(plus(heel, way, -4 * mm), { speed = 60 * mm / s })
      stroke(hook, tissue, how, way, axis)
      hook:move_by(plus(times(way, -2 * mm), back, 14 * mm), { speed = 100 * mm / s })
    end
    missed = t:torn(tissue) > torn and 0 or missed + 1
  end
end

-- ---- clips and scissors

--- How many clips of a tube, or of a piece of one, are shut.
function technique.shut(t, tube)
  local count = 0
  for _, clip in ipairs(t:clips(tube)) do
    if clip.opening == 0 then count = count + 1 end
  end
  return count
end

--- How far, rad, a shaft from a port (its place) is to be turned for its jaws to open across a tube, which runs `along`
--- at the place `at`: t:along says both.
function technique.roll_across(port, at, along)
  if length(minus(at, port)) == 0 then error("technique.roll_across: port and at are one place", 2) end
  local x, y = frame_of(port, at)
  return math.atan(-dot(x, along) / dot(y, along))
end

local past = { "past", given.between(-0.2, 0.2, "a way of at most 200 mm", "mm") }
local speed = { "speed", given.optional(given.between(0, 0.5, "a speed of up to 500 mm / s", "mm / s")) }
local open = { "open", given.between(0, math.pi, "an angle of up to 180 degrees", "deg") }
local hands = {
  enter = {},
  about = { { "tube", given.name }, { "share", given.share }, past, speed },
  back = { { "way", given.between(0, 0.3, "a way of up to 300 mm", "mm") }, speed },
  set_clips = { { "tube", given.name }, { "shares", given.shares }, open, past },
}

--- An instrument as a demo moves it about tubes: it knows how it is turned, and where its port is.
function technique.hand(t, name, port)
  local self = { tool = t[name], rolled = 0 }
  --- It comes in where it waits for its port.
  function self.enter()
    if not self.tool:waits() then return end
    self.tool:exchange()
    self.rolled = 0
  end
  --- Open jaws come about a tube, their tips that far past its middle.
  local function about(tube, share, beyond, fast)
    local at, along = t:along(tube, share)
    local turn = technique.roll_across(port, at, along) - self.rolled
    turn = turn - math.pi * math.floor(turn / math.pi + 0.5) -- jaws are alike on both sides
    if math.abs(turn) > 15 * deg then
      self.tool:rotate(turn, { speed = 300 * deg / s })
      self.rolled = self.rolled + turn
    end
    self.tool:move_to(plus(at, unit(minus(at, port)), beyond), { speed = fast })
  end
  self.about = about
  local function back(way, fast)
    self.tool:move_by(times(unit(minus(port, self.tool:tip())), way), { speed = fast or 150 * mm / s })
  end
  self.back = back
  --- Clips at these shares of a tube's way: jaws that come about it, then fire.
  function self.set_clips(tube, shares, wide, beyond)
    self.tool:open(wide)
    about(tube, shares[1], -12 * mm, 150 * mm / s)
    for _, share in ipairs(shares) do
      about(tube, share, beyond, 40 * mm / s)
      self.tool:fire()
    end
    back(25 * mm)
  end
  for act, takes in pairs(hands) do self[act] = given.checked(name .. "'s hand." .. act, takes, self[act]) end
  return self
end

--- A rule: a clip slides off a stump that is too short: how far a tube was cut from the nearest clip, on either side.
function technique.judge_stump(run, tube)
  local cuts = run:times("cut", tube)
  if #cuts == 0 then return 0, "it was never cut" end
  local nearest, behind = math.huge, cuts[1]
  for _, cut in ipairs(run.events) do
    for _, clip in ipairs(run.events) do
      if cut.event == "cut" and cut.organ == tube and clip.event == "clip" and clip.organ:find(tube, 1, true) == 1
        and clip.time < cut.time then
        local distance = length(minus(clip.place, cut.place))
        if distance < nearest then nearest, behind = distance, clip.time end
      end
    end
  end
  if nearest == math.huge then return 0, "there was no clip when it was cut", cuts end
  local share = math.min(1, math.max(0, (nearest - 0.5 * mm) / (1.5 * mm)))
  return share, string.format("it was cut %.1f mm from the nearest clip; 2 mm leave a stump", nearest / mm),
    { behind, cuts[1] }
end

-- ---- what they take

local t, tool, tube, a, b = { "t", given.exercise }, { "tool", given.tool }, { "tube", given.name },
  { "a", given.three }, { "b", given.three }
for name, takes in pairs {
  plus = { a, b, { "share", given.optional(given.number) } }, minus = { a, b }, dot = { a, b }, length = { a },
  unit = { { "a", given.way } }, triangle = { t }, angle_of_ducts = { t }, lift_step = { t }, lift = { tool },
  burn_wall = { tool },
  draw_slack = { t, tool, { "slack", given.above_zero } },
  take = { t, tool, { "tissue", given.name }, { "how", given.by_name } },
  free = { t, tool, { "tissue", given.name }, { "how", given.by_name } }, shut = { t, tube },
  roll_across = { { "port", given.three }, { "at", given.three }, { "along", given.way } },
  hand = { t, { "name", given.name }, { "port", given.three } }, judge_stump = { { "run", given.run }, tube },
} do technique[name] = given.checked("technique." .. name, takes, technique[name]) end

return technique
