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

--- Of the strands that are wanted (nil: all) the one nearest to a place; nil: there is none.
local function nearest_strand(t, place, tissue, wanted)
  local best, least = nil, math.huge
  for _, strand in ipairs(t:strands(tissue)) do
    local far = length(minus(strand.middle, place))
    if far < least and (not wanted or wanted(strand)) then
      best, least = strand, far
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

--- Whether what the hook, or the part named, presses on most is the tissue.
local function lies_on(hook, tissue, part)
  local contact = hook:contact(part)
  return contact ~= nil and contact.organ == tissue
end

--- Current, a tenth of a second at a time, while it may flow and until a strand has parted, so many times at most.
--- Whether one has.
local function burn_strand(t, hook, tissue, tries, may_burn)
  local standing = #t:strands(tissue)
  for _ = 1, tries do
    if not may_burn() or #t:strands(tissue) < standing then break end
    hook:activate(0.1 * s)
  end
  return #t:strands(tissue) < standing
end

--- A mistake: current on the gallbladder's wall at its neck, until it is open; then the hook leaves.
function technique.burn_wall(hook)
  hook:approach("gallbladder.neck", { speed = 60 * mm / s, depth = 2 * mm, offset = { -8 * mm, -2 * mm, 3 * mm } })
  hook:move_until(function() return lies_on(hook, "gallbladder") end,
    { towards = "gallbladder.neck", speed = 25 * mm / s, limit = 15 * mm })
  hook:activate(2 * s)
  hook:move_by({ 10 * mm, 20 * mm, 60 * mm }, { speed = 100 * mm / s })
end

local function is_done(how) return how.is_done ~= nil and how.is_done() end

local how_to_take = {
  port = given.three, tries = given.whole, hardest = given.above_zero, wanted = given.optional(given.called),
  is_done = given.optional(given.called), keep_off = given.optional(given.list),
}
local where_to_keep_off = { organ = given.name, place = given.optional(given.three), clear = given.above_zero }

--- Strand by strand: the hook's foot, which points to the patient's right, comes down on the nearest one and draws
--- back off the walls that it lies on too, as they would be burnt. Current flows until one strand has parted; else the
--- foot comes down nearer to either end of it, as what a slack strand hangs on may keep the hook off its middle, and
--- then on all three nearer to its heel. One that is missed all nine times is left until another one has parted, and
--- after three that are it gives up. Before a longer way it is drawn out. `how`: port, where its shaft comes from;
--- tries, of a tenth of a second; hardest, the force that ends its way down; wanted(strand), if given, those that are
--- taken; is_done(), if given, asked before each strand; keep_off, a list of organs: current flows no nearer to one
--- than by its `clear`; and a place of one, if given, beside which the heel comes down first, on the middle, and the
--- foot points away.
function technique.take(t, hook, tissue, how)
  given.check(how, how_to_take, "technique.take", 2)
  local organs = how.keep_off or {}
  for _, off in ipairs(organs) do given.check(off, where_to_keep_off, "keep_off", 2) end
  local reach, by_heel = { 4 * mm, 2 * mm, 0.5 * mm }, { 0.7 * mm, -0.5 * mm, -1.5 * mm }
  local missed, left, left_in_all = 0, {}, 0 -- left: by where they begin, which tells one from the others
  local function wanted(strand) return not left[strand.share] and (not how.wanted or how.wanted(strand)) end
  while left_in_all < 3 and not is_done(how) do
    local strand = nearest_strand(t, hook:tip(), tissue, wanted)
    if not strand then return end
    local beside = false
    for _, off in ipairs(organs) do
      beside = beside or off.place and length(minus(strand.middle, off.place)) < 10 * mm
    end
    local ends = { strand.middle, strand.to, strand.from }
    local at = beside and strand.middle or plus(strand.middle, minus(ends[missed % 3 + 1], strand.middle), 0.5)
    local aim = plus(at, { beside and by_heel[missed % 3 + 1] or reach[missed // 3 + 1], 0, 0 })
    local back = unit(minus(how.port, at))
    if length(minus(aim, hook:tip())) > 12 * mm then draw_out(hook, back) end
    hook:move_to(plus(aim, back, 5 * mm), { speed = 80 * mm / s })
    local function lies_on_it() return lies_on(hook, tissue) or hook:force() > how.hardest end
    local function may_burn()
      for _, off in ipairs(organs) do
        if hook:clearance(off.organ) < off.clear then return false end
      end
      return hook:touching()
    end
    hook:move_until(lies_on_it, { along = times(back, -1), speed = 25 * mm / s, limit = 8 * mm })
    hook:move_until(function()
      local contact = hook:contact()
      return contact == nil or contact.organ == tissue
    end, { along = back, speed = 5 * mm / s, limit = 2 * mm })
    if burn_strand(t, hook, tissue, how.tries, may_burn) then
      missed, left, left_in_all = 0, {}, 0
    elseif missed < 8 then
      missed = missed + 1
    else
      missed, left_in_all = 0, left_in_all + 1
      left[strand.share] = true
    end
    hook:move_by(times(back, 5 * mm), { speed = 80 * mm / s })
  end
end

--- Draws an instrument back along its shaft, until its tip is 30 mm before its port, a place.
function technique.withdraw(tool, port)
  local inward = unit(minus(tool:tip(), port))
  tool:move_to(plus(port, inward, 30 * mm), { speed = 150 * mm / s })
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

local function middle_of(strands)
  local sum = { 0, 0, 0 }
  for _, strand in ipairs(strands) do sum = plus(sum, strand.middle) end
  return times(sum, 1 / #strands)
end

--- The strands that are wanted (nil: all), under tension and longer than the hook's foot is thick, and of these the
--- one nearest to a place.
local function open_strands(t, tissue, place, wanted)
  local open, nearest, least = {}, nil, math.huge
  for _, strand in ipairs(t:strands(tissue)) do
    if strand.tension > 10e-3 * N and length(minus(strand.from, strand.to)) > 3.5 * mm
      and (not wanted or wanted(strand)) then
      open[#open + 1] = strand
      local far = length(minus(strand.middle, place))
      if far < least then nearest, least = strand, far end
    end
  end
  return open, nearest
end

--- The plane's front nearest to a place: see technique.free. nil: nothing is under tension.
local function front_of(t, tissue, how, place)
  local open, nearest = open_strands(t, tissue, place, how.wanted)
  if not nearest then return nil end
  local near, out, tension = {}, { 0, 0, 0 }, 0
  for _, strand in ipairs(open) do
    if length(minus(strand.middle, nearest.middle)) < 18 * mm then
      near[#near + 1] = strand
      out = plus(out, unit(minus(strand.from, strand.to)), strand.tension)
      tension = math.max(tension, strand.tension)
    end
  end
  local at = middle_of(near)
  out = unit(out)
  local inward = unit(across(t.laparoscope:direction(), out))
  local along = cross(inward, out)
  if dot(along, minus(at, how.port)) < 0 then along = times(along, -1) end
  return { at = at, out = out, along = along, inward = inward, tension = tension, strands = near }
end

--- Of each 2.5 mm of the front's way the foremost strand's middle, from the near side to the far one: but for those
--- that stand 9 mm behind the very first, as the way to them leads over an organ.
local function foremost(front)
  local wide, behind, rows, line, least = 2.5 * mm, 9 * mm, {}, {}, math.huge
  for _, strand in ipairs(front.strands) do
    local from = minus(strand.middle, front.at)
    local row, deep = math.floor(dot(from, front.along) / wide), dot(from, front.inward)
    if not rows[row] or deep < rows[row].deep then rows[row] = { deep = deep, row = row, middle = strand.middle } end
    least = math.min(least, deep)
  end
  for _, row in pairs(rows) do
    if row.deep < least + behind then line[#line + 1] = row end
  end
  table.sort(line, function(a, b) return a.row < b.row end)
  return line
end

local harmless = 0.5 * mm -- from an organ's skin, beyond which current spares it

local function presses(hook, how) return hook:force("tip") > how.hardest or hook:force() > 2.5 * N end

local function within(value, most) return math.max(-most, math.min(most, value)) end

--- How far the foot is from the organ that is nearer, and how far it would move off the first one to lie midway.
local function between(hook, how)
  local below, above = hook:clearance(how.between[1]), hook:clearance(how.between[2])
  return math.min(below, above), 0.5 * (above - below)
end

--- Moves the foot along `out` until it is midway between the two organs, or 0.8 mm off both.
local function centre(hook, how, out)
  for _ = 1, 4 do
    local skin, aside = between(hook, how)
    if skin > 0.8 * mm or math.abs(aside) < 0.3 * mm then return end
    hook:move_by(times(out, within(aside, 1 * mm)), { speed = 30 * mm / s })
  end
end

--- One piece of a sweep, of 3 mm at most: with current, if the foot lies on the tissue, until it no longer does.
local function sweep_on(hook, tissue, how, step, burns)
  local since = 0
  hook:move_until(function()
    since = lies_on(hook, tissue, "tip") and 0 or since + 1
    if is_done(how) or presses(hook, how) then return true end
    if burns then return since > 3 or between(hook, how) < harmless end
    return since == 0
  end, { along = step, speed = (burns and 20 or 40) * mm / s, limit = length(step), active = burns })
end

--- Moves the hook to a place, with current while its foot lies on the tissue, and off the nearer organ where it presses
--- on one or would burn it. Whether it came there.
local function sweep_to(hook, tissue, how, front, place)
  local eased = 0
  for _ = 1, 30 do
    local way = minus(place, hook:tip())
    local far, on_it = length(way), lies_on(hook, tissue, "tip")
    if far < 0.4 * mm then return true end
    if is_done(how) then return false end
    if how.ease then how.ease() end
    local skin, aside = between(hook, how)
    if on_it and skin > harmless and hook:force("tip") > how.hardest then
      hook:activate(0.12 * s)
    elseif presses(hook, how) or on_it and skin < harmless then
      if eased == 4 then return false end
      eased = eased + 1
      local off = within(aside, 0.8 * mm)
      place = plus(place, front.out, off)
      hook:move_by(plus(times(front.inward, -0.5 * mm), front.out, off), { speed = 30 * mm / s })
    else
      aside = skin < 1 * mm and within(aside, 1 * mm) or 0
      place = plus(place, front.out, aside)
      local step = plus(times(way, math.min(1, 3 * mm / far)), front.out, aside)
      sweep_on(hook, tissue, how, step, on_it)
    end
  end
  return false
end

--- Turns a shaft that is rolled by an angle to another one, the shorter way round; by less than 10 degrees not at all.
--- How it is rolled then, rad.
local function roll_to(hook, to, rolled)
  local turn = to - rolled
  turn = turn - 2 * math.pi * math.floor(turn / (2 * math.pi) + 0.5)
  if math.abs(turn) <= 10 * deg then return rolled end
  hook:rotate(turn, { speed = 400 * deg / s })
  return rolled + turn
end

--- Turns a shaft that is rolled by an angle back to where it was.
local function unroll(hook, rolled)
  if rolled ~= 0 then hook:rotate(-rolled, { speed = 400 * deg / s }) end
end

-- ---- a strand hooked from behind

--- For one strand: `at`, its middle, moved `aside` towards the organ that it begins at; `out`, its way from the other
--- organ to that one; `deep`, the shaft's way; `foot`, where the hook's foot points, across the strand, towards the
--- side on which more of the others stand; and `turn`, how far the shaft is turned then, rad.
local function grip_on(t, tissue, port, strand, aside)
  local out = unit(minus(strand.from, strand.to))
  local at = plus(strand.middle, out, aside)
  local turn, x, y = technique.roll_across(port, at, out), frame_of(port, at)
  local foot, ahead = plus(times(x, math.cos(turn)), y, math.sin(turn)), 0
  for _, other in ipairs(t:strands(tissue)) do
    local far = minus(other.middle, at)
    if length(far) < 10 * mm then ahead = ahead + dot(far, foot) end
  end
  if ahead < 0 then
    turn, foot = turn + math.pi, times(foot, -1)
  end
  return { at = at, out = out, deep = unit(minus(at, port)), foot = foot, turn = turn }
end

--- Draws the hook back until the strand lies on its foot, midway between the two organs.
local function draw_on(hook, tissue, how, grip)
  local back, most = times(unit(across(grip.deep, grip.out)), -1), 0.5 * mm
  local function hangs() return lies_on(hook, tissue, "tip") and hook:force("tip") > 0.08 * N end
  for _ = 1, 10 do
    if hangs() then return end
    local _, aside = between(hook, how)
    local way = plus(times(back, most), grip.out, within(aside, most))
    hook:move_until(hangs, { along = way, speed = 5 * mm / s, limit = length(way) })
  end
end

local how_to_hook = {
  port = given.three, hardest = given.above_zero, between = given.two_names, wanted = given.optional(given.called),
  is_done = given.optional(given.called),
}

--- Tries one strand; `try`: how the shaft is rolled, how many tries in a row divided nothing, and how far aside of the
--- strand's middle the foot goes; renewed.
local function hook_strand(t, hook, tissue, how, strand, try)
  local beside, before, deeper = -7.5 * mm, -12 * mm, { 0, 1.5 * mm, 3 * mm, -1.5 * mm }
  local grip = grip_on(t, tissue, how.port, strand, try.aside)
  local behind = 1.5 * mm + deeper[try.missed % 4 + 1]
  local function go(along, down, speed)
    local way = minus(plus(plus(grip.at, grip.foot, along), grip.deep, down), hook:tip())
    if length(way) < 0.2 * mm then return end -- it is there
    hook:move_until(function() return presses(hook, how) end, { along = way, speed = speed, limit = length(way) })
  end
  try.rolled = roll_to(hook, grip.turn, try.rolled)
  go(beside, before, 100 * mm / s)
  go(beside, behind, 40 * mm / s)
  go(-2 * mm, behind, 20 * mm / s)
  local _, off = between(hook, how)
  draw_on(hook, tissue, how, grip)
  local function may_burn() return lies_on(hook, tissue, "tip") and between(hook, how) >= 0.3 * mm end
  if burn_strand(t, hook, tissue, 30, may_burn) then
    try.missed, try.aside = 0, 0
  else
    local most = 0.5 * length(minus(strand.from, strand.to))
    try.missed, try.aside = try.missed + 1, within(try.aside + within(off, 0.8 * mm), most)
  end
  go(beside, behind, 20 * mm / s)
  go(beside, before, 60 * mm / s)
end

--- Strand by strand, from whichever side the shaft comes, which is not turned and is turned back at the end: beside a
--- strand, on the side where fewer others stand, the hook goes 1.5 mm deeper than its middle, its foot slides behind it
--- and draws back until the strand hangs on it, off both organs' walls. Then current flows, if no wall is within 0.3
--- mm, until one strand has parted. Where none does the hook tries again, nearer to the middle between the walls and
--- less or more deep, up to nine times in a row. `how`: port, where the shaft comes from; hardest, the force on its
--- foot that ends a way; between, the two organs, first the one that the tissue ends on; wanted(strand), if given,
--- those that are taken; is_done(), if given, asked before each.
function technique.hook(t, hook, tissue, how)
  given.check(how, how_to_hook, "technique.hook", 2)
  local try = { rolled = 0, missed = 0, aside = 0 }
  while try.missed < 9 and not is_done(how) do
    local strand = nearest_strand(t, hook:tip(), tissue, how.wanted)
    if not strand then break end
    hook_strand(t, hook, tissue, how, strand, try)
  end
  unroll(hook, try.rolled)
end

-- ---- the plane, by strokes

local how_to_free = {
  port = given.three, from = given.three, hardest = given.above_zero, between = given.two_names,
  wanted = given.optional(given.called), stretch = given.optional(given.called), ease = given.optional(given.called),
  is_done = given.optional(given.called),
}

--- Where the foot's heel goes for its end to be 3 mm past a strand of the front.
local function heel(front, back, strand)
  local foot = 5 * mm
  return plus(strand, front.inward, 3 * mm - foot * length(across(front.inward, back)))
end

--- Brings the hook 5 mm before a place of the front, where the organs stand further apart, its foot inward, and midway
--- between them. The angle that it is rolled by then, rad.
local function come_to(hook, how, front, place, rolled)
  local start = plus(place, front.inward, -5 * mm)
  local back = unit(minus(how.port, start))
  local foot, x, y = unit(across(front.inward, back)), frame_of(how.port, start)
  rolled = roll_to(hook, math.atan(dot(y, foot), dot(x, foot)), rolled)
  hook:move_to(plus(start, back, 12 * mm), { speed = 100 * mm / s })
  hook:move_until(function() return presses(hook, how) end,
    { along = times(back, -1), speed = 60 * mm / s, limit = 12 * mm })
  centre(hook, how, front.out)
  return rolled
end

--- Sweeps to and fro along the front, first from one of its rows on, until a way divides less than a hundredth of the
--- tissue or fails twice. The plane is stretched anew before each way.
local function sweep(t, hook, tissue, how, front, back, first)
  local place = front.at
  for way = 1, 8 do
    local torn, line, failed = t:torn(tissue), foremost(front), 0
    for k = first, #line do
      local row = line[way % 2 == 1 and k or #line + 1 - k]
      if not sweep_to(hook, tissue, how, front, heel(front, back, row.middle)) then
        failed = failed + 1
        hook:move_by(times(front.inward, -2 * mm), { speed = 60 * mm / s })
      end
      if is_done(how) or failed == 2 then return end
    end
    first, front = 1, front_of(t, tissue, how, place)
    if not front or t:torn(tissue) - torn < 0.01 then return end
    if how.stretch then how.stretch(front) end
  end
end

--- Takes a tissue off by strokes of the hook along its front, where it stands open under tension as the laparoscope
--- sees it. The shaft is not turned at first, and is turned back at the end. The hook comes to the front from its open
--- side, midway between the two organs, its foot inward, away from the lens, and 3 mm past the foremost strands. It
--- sweeps to and fro along them, and current flows while it lies on strands and no organ is within 0.5 mm. It ends when
--- nothing is under tension, or ten strokes in a row divide nothing; after two of these it tries one strand alone as
--- well, from behind. `how`: port, where the shaft comes from; from, the place nearest to which it begins; hardest, the
--- force on the foot at which it stops and burns, or eases off a skin; between, the two organs, first the one that the
--- tissue ends on; wanted(strand), if given, those that make up the front, such as those that the laparoscope sees;
--- stretch(front), if given, called before each way to keep the plane under tension; ease(), if given, every 3 mm of a
--- way; is_done(), if given. `front`: at, its middle; out, from the first organ to the other one; along, its own way,
--- as the shaft points; inward, to the strands behind it; tension, of its tautest strand.
function technique.free(t, hook, tissue, how)
  given.check(how, how_to_free, "technique.free", 2)
  local missed, rolled, near, try = 0, 0, how.from, { missed = 0, aside = 0 }
  while missed < 10 and not is_done(how) do
    local torn, front = t:torn(tissue), front_of(t, tissue, how, near)
    if front and how.stretch then
      how.stretch(front)
      front = front_of(t, tissue, how, near)
    end
    if not front then break end
    near = front.at
    local line = foremost(front)
    local first = 1 + (#line // 2 + missed) % #line -- the near side is where the two organs lie on each other
    local strand = line[first].middle
    local back = unit(minus(how.port, strand))
    rolled = come_to(hook, how, front, heel(front, back, strand), rolled)
    sweep(t, hook, tissue, how, front, back, first)
    hook:move_by(times(front.inward, -4 * mm), { speed = 60 * mm / s })
    hook:move_by(times(back, 15 * mm), { speed = 100 * mm / s })
    local alone = missed > 0 and t:torn(tissue) == torn and nearest_strand(t, strand, tissue, how.wanted)
    if alone and not is_done(how) then
      try.rolled = rolled
      hook_strand(t, hook, tissue, how, alone, try)
      rolled = try.rolled
    end
    missed = t:torn(tissue) > torn and 0 or missed + 1
  end
  unroll(hook, rolled)
end

local how_to_draw = {
  along = given.way, firmly = given.above_zero, least = given.above_zero, most = given.above_zero,
  distance = given.above_zero, follow = given.optional(given.called),
}

--- A hand that keeps a plane open while the hook divides it: two functions, for technique.free's stretch and ease.
--- The first draws that way until the hand feels the force, by 15 mm at most: 0.4 N more where the last way of the hook
--- has divided less than a hundredth of the tissue. The laparoscope looks at the front meanwhile. The second goes back
--- to 0.8 of what is left of the force where the plane has given way to the pull, or that would run on by itself: where
--- two hundredths of it are divided and 0.15 of the force is gone. `how`: along, the way; firmly, the force; least and
--- most, between which it stays; distance, of the laparoscope from the front; follow(), if given, called after each
--- draw, such as to turn the hand's shaft.
function technique.drawing_hand(t, hand, tissue, how)
  given.check(how, how_to_draw, "technique.drawing_hand", 2)
  local firmly, torn, held = how.firmly, -1, 0
  local function taut() return hand:force("jaws") > firmly end
  local function draw(front)
    if t:torn(tissue) - torn < 0.01 then firmly = math.min(how.most, firmly + 0.4 * N) end
    torn = t:torn(tissue)
    t:together(function()
      hand:move_until(taut, { along = how.along, speed = 25 * mm / s, limit = 15 * mm })
      if how.follow then how.follow() end
      held = hand:force("jaws")
    end, function()
      t.laparoscope:look_at(front.at, { distance = how.distance })
    end)
  end
  local function ease()
    local force = hand:force("jaws")
    if force > 0.85 * held or t:torn(tissue) - torn < 0.02 then return end
    firmly = math.max(how.least, 0.8 * force)
    hand:move_until(function() return not taut() end,
      { along = times(how.along, -1), speed = 25 * mm / s, limit = 15 * mm })
    held = hand:force("jaws")
  end
  return draw, ease
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

--- A rule: how much of a plane, a tissue, was divided, beside the share of it that is asked for.
function technique.judge_plane(run, tissue, asked)
  local torn = (run.metrics[tissue .. ".torn_pct"] or 0) / 100
  return math.min(1, torn / asked), string.format("%.0f %% of the plane divided", 100 * torn),
    run:times("divided", tissue)
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
  free = { t, tool, { "tissue", given.name }, { "how", given.by_name } },
  drawing_hand = { t, tool, { "tissue", given.name }, { "how", given.by_name } },
  hook = { t, tool, { "tissue", given.name }, { "how", given.by_name } }, shut = { t, tube },
  roll_across = { { "port", given.three }, { "at", given.three }, { "along", given.way } },
  hand = { t, { "name", given.name }, { "port", given.three } }, withdraw = { tool, { "port", given.three } },
  judge_plane = { { "run", given.run }, { "tissue", given.name }, { "asked", given.above_zero } },
  judge_stump = { { "run", given.run }, tube },
} do technique[name] = given.checked("technique." .. name, takes, technique[name]) end

return technique
