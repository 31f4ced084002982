-- The operating field of a cholecystectomy as data: what scene.anatomy takes, from a few lengths.
--
--   local anatomy = require "anatomy"
--   scene = function() return { anatomy = anatomy.standard { cystic_duct_length = 12 * mm }, ... } end
--
-- Defaults and ranges of anatomy.standard's parameters (published: mean or usual value, range in brackets):
--   gallbladder_length 80 mm (70 to 100), gallbladder_width 33 mm (30 to 40): doi 10.1155/2016/7201858
--   fill_pressure 12 mmHg (10 to 15): common knowledge, uncalibrated
--   cystic_duct_length 20 mm (20.6 +- 11.4, 6 to 55), cystic_duct_diameter 3.6 mm (3.2, 2 to 6):
--     doi 10.4103/NJCA.NJCA_69_21
--   common_duct_diameter 6 mm (up to 6); hepatic part 26 mm (about 30): the same
--   common_duct_widest false: the width of a duct that a stone further down has dilated, beyond some 7 mm: common
--     knowledge, uncalibrated
--   cystic_artery_length 17 mm (16.9, 2 to 55), cystic_artery_diameter 1.6 mm (1 to 5): Sherifi, IJAE 123(2):158
--   its two branches on the gallbladder, superficial and deep: drawn by eye
--   cystic_artery_enters { -3.5, -13.5, 2 }: where it reaches the gallbladder, in mm from the bed's neck: towards the
--     liver, to the patient's right and back, towards the fundus; from a place off its wall it turns to the wall
--   looks "bile": "pale" is how a gallbladder full of mucus looks (hydrops)
--   without {}: names of organs and tissues that are gone already, in a field that is prepared for a later step
--   prepared {}: what is gone of a tissue already, cleared from one end of the organ that it begins on:
--     { triangle_fat = 0.8 } of its way from its start (the gallbladder's side), 0 to 1; { cystic_plate = { 0.5, 1 } }
--     of its way from 0.5 to 1: up to one of its ends. What stands comes to rest without it. Of a tube it leaves a
--     stump, joined to nothing and not held where it ends: { cystic_duct = 0.4 } was divided and its upper part is
--     gone; tissue that begins on it is in without
--   strength 1: how many times as strong tissue is, and as hard to divide: some 25 in a scarred triangle
--   areolar_plane false: with true the cystic plate is the loose plane in which a healthy gallbladder is taken off its
--     bed: five times as many strands, which tear at 0.4 of its stress, as fat does in the triangle, and at two thirds
--     of its energy; current divides them with a tenth of its energy: uncalibrated; drawn as fibres
--   hepatic_ducts false: with true the right and the left hepatic duct, which join at the common duct's beginning, are
--     there to be hurt: 10 mm (9) and 17 mm (17) long, 4 mm (3 to 4) across: common knowledge, uncalibrated. Without
--     them the common duct comes out of the hilum, at no cost
--   aberrant_duct false: with true a right posterior sectoral duct of its own, 2.6 mm across, crosses the triangle and
--     enters the common hepatic duct at aberrant_union 0.2 of the common duct: drawn by eye, uncalibrated
--   assistant true: a hand that holds the fundus up, as drawn; without it the organs hang 20 mm lower
--   union 0.38, the share of the common duct at which the cystic duct enters; union_lies, by which the common duct is
--     moved there; node_diameter 5 mm; bed_stiffness;
--     all strengths of tissue; where things lie beside each other: uncalibrated, no source gives them
-- The gallbladder's pouch, its neck, and the course of duct and arteries are drawn by eye: uncalibrated.

local calot = require "calot"
local given = require "given"
local mm, kPa, mmHg = calot.units.mm, calot.units.kPa, calot.units.mmHg

local anatomy = given.module "anatomy"

-- ---- points

local function add(a, b, share)
  share = share or 1
  return { a[1] + share * b[1], a[2] + share * b[2], a[3] + share * b[3] }
end
local function minus(a, b) return add(a, b, -1) end
local function dot(a, b) return a[1] * b[1] + a[2] * b[2] + a[3] * b[3] end
local function times(a, share) return { a[1] * share, a[2] * share, a[3] * share } end
local function length(a) return math.sqrt(dot(a, a)) end
local function unit(a) return times(a, 1 / length(a)) end
local function cross(a, b)
  return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
end

--- A place at a share of the way along a line of points: anatomy.along(duct.shape.points, 0.3).
function anatomy.along(points, share)
  local whole = 0
  for k = 2, #points do whole = whole + length(minus(points[k], points[k - 1])) end
  local left = share * whole
  for k = 2, #points do
    local way = minus(points[k], points[k - 1])
    if left <= length(way) or k == #points then return add(points[k - 1], way, left / length(way)) end
    left = left - length(way)
  end
end

--- The radius of a tube's shape at a share of the way along it.
function anatomy.radius_along(shape, share)
  if not shape.radii then return shape.radius + share * ((shape.end_radius or shape.radius) - shape.radius) end
  local points, ways = shape.points, { 0 }
  for k = 2, #points do ways[k] = ways[k - 1] + length(minus(points[k], points[k - 1])) end
  for k = 2, #points do
    local before, behind = ways[k - 1] / ways[#ways], ways[k] / ways[#ways]
    if share <= behind then
      return shape.radii[k - 1] + (share - before) / (behind - before) * (shape.radii[k] - shape.radii[k - 1])
    end
  end
  return shape.radii[#points]
end

--- A line from one place to another that bows aside until it is as long as asked; straight where that is too short.
local function bowed(from, to, long, aside)
  local way = minus(to, from)
  local straight = length(way)
  -- Of a flat parabola: long = straight * (1 + 8/3 (rise / straight)^2).
  local rise = straight * math.sqrt(math.max(0, 3 / 8 * (long / straight - 1)))
  local out = {}
  for k = 0, 4 do
    local t = k / 4
    out[#out + 1] = add(add(from, way, t), aside, 4 * t * (1 - t) * rise)
  end
  return out
end

--- The place on a swept shape's wall nearest to another one, and how far off the wall that one is, m; inside: below 0.
local function on_wall(shape, at)
  local nearest, gap = at, math.huge
  for k = 2, #shape.along do
    local from, to = shape.along[k - 1], shape.along[k]
    local way = minus(to.at, from.at)
    local share = math.max(0, math.min(1, dot(minus(at, from.at), way) / dot(way, way)))
    local centre, radius = add(from.at, way, share), from.radius + share * (to.radius - from.radius)
    local off = length(minus(at, centre)) - radius
    if off < gap then nearest, gap = add(centre, unit(minus(at, centre)), radius), off end
  end
  return nearest, gap
end

-- ---- the frame of the bed, { towards the liver, to the patient's right and back, towards the fundus }

-- As the first assistant exposes it: the fundus is up over the liver, which turns its underside to the laparoscope.
local bed_neck, bed_fundus = { -50 * mm, 120 * mm, -112 * mm }, { -90 * mm, 156 * mm, -53 * mm }
local liver_side = { 0.1, 0.75, -0.65 }
local towards_fundus = unit(minus(bed_fundus, bed_neck))
local towards_liver = unit(minus(liver_side, times(towards_fundus, dot(liver_side, towards_fundus))))
local aside = cross(towards_fundus, towards_liver)

--- A place in the patient's frame, m, of which x, y, z say in mm how far it is from the neck's end of the liver's bed:
--- towards the liver, to the patient's right and back, towards the fundus.
function anatomy.place(x, y, z)
  return add(add(add(bed_neck, towards_liver, x * mm), aside, y * mm), towards_fundus, z * mm)
end
local place = anatomy.place
local caudal, back = { 0, -1, 0 }, { 0, 0, -1 }

-- ---- organs

local defaults = {
  gallbladder_length = 80 * mm,
  gallbladder_width = 33 * mm,
  fill_pressure = 12 * mmHg,
  phrygian_cap = false,
  cystic_duct_length = 20 * mm,
  cystic_duct_diameter = 3.6 * mm,
  common_duct_diameter = 6 * mm,
  common_duct_widest = false,
  union = 0.38,
  union_lies = { 0, 0, 0 },
  cystic_artery_length = 17 * mm,
  cystic_artery_diameter = 1.6 * mm,
  cystic_artery_enters = { -3.5, -13.5, 2 },
  second_cystic_artery = false,
  hepatic_artery_near_neck = false,
  areolar_plane = false,
  hepatic_ducts = false,
  aberrant_duct = false,
  aberrant_union = 0.2,
  node_diameter = 5 * mm,
  assistant = true,
  looks = "bile",
  nodes = 200,
  strands = 1,
  strength = 1,
  without = {},
  prepared = {},
}

local function up_to(most) return given.between(0, most * mm, "a length above 0, up to " .. most .. " mm", "mm") end
--- What each may be: of the kind of its default, but for some.
local kinds = {
  gallbladder_length = up_to(200), gallbladder_width = up_to(100), cystic_duct_length = up_to(120),
  cystic_duct_diameter = up_to(20), common_duct_diameter = up_to(30), cystic_artery_length = up_to(120),
  cystic_artery_diameter = up_to(10), node_diameter = up_to(30),
  fill_pressure = given.between(40, 30 * kPa, "a pressure of 40 Pa to 30 kPa", "mmHg"),
  common_duct_widest = given.or_false(given.above_zero),
  union = given.part,
  aberrant_union = given.part,
  union_lies = given.three,
  cystic_artery_enters = given.three,
  nodes = given.whole,
  without = given.names,
  prepared = given.by_name,
}
for key, value in pairs(defaults) do
  local usual = { number = given.above_zero, boolean = given.yes_or_no, string = given.name }
  kinds[key] = given.optional(kinds[key] or usual[type(value)])
end

local function soft_wall(thickness) return { thickness = thickness, density = 1050 } end

--- Places in the bed's frame, and radii, in mm. Its neck bends off its pouch towards the hilum.
local function gallbladder(p)
  local long, wide = p.gallbladder_length / (80 * mm), p.gallbladder_width / (33 * mm)
  local along = {}
  local function station(x, y, z, radius, refine)
    along[#along + 1] = { at = place(x, y, z), radius = radius * mm, refine = refine }
  end
  station(-2, -23, 3, 2.6)
  station(-5, -17, 3.5, 3.6)
  station(-8, -10, 7.5, 6)
  station(-9, -3.5, 14.5, 9)
  station(-5.5, -0.5, 24, 10.2)
  station(-1.5, 0, 36, 13.2 * wide)
  station(0, 0, 36 + 13 * long, 16.4 * wide)
  if p.phrygian_cap then -- the fundus folds over towards the free side
    station(-1, 0, 36 + 26 * long, 15 * wide)
    station(-8, 0, 36 + 38 * long, 10.5 * wide)
    station(-21, 0, 36 + 44 * long, 10 * wide)
  else
    station(0, 0, 36 + 27 * long, 16.4 * wide)
    station(0, 0, 36 + 44 * long, 15.5 * wide, 1.6)
  end
  local held = { { name = "bed", landmark = "bed", radius = 22 * mm, stiffness = 3e5, while_filled = true } }
  if p.assistant then
    held[2] = { name = "assistant", landmark = "fundus", radius = 13 * mm, stiffness = 2e6 }
  end
  return {
    name = "gallbladder",
    shape = { type = "swept", along = along },
    liver_side = liver_side,
    nodes = p.nodes,
    wall = soft_wall(2 * mm),
    bile = { fill_pressure = p.fill_pressure },
    held = held,
    looks = p.looks,
  }
end

--- The cystic artery's branches on the gallbladder, places in the bed's frame: the superficial one over the free side,
--- the deep one between gallbladder and bed; each from an artery of its own where there are two. They are drawn on the
--- wall: as bodies they would cost nodes in each step, and what feels and bleeds in the triangle is the artery.
local second_enters = { -4, -9, 4.5 }
local function branches(p, enters, deep_enters)
  local long = p.gallbladder_length / (80 * mm)
  local function vessel(radius, from, places)
    local points = { place(table.unpack(from)) }
    for _, at in ipairs(places) do
      points[#points + 1] = place(at[1], at[2], at[3] <= 36 and at[3] or 36 + (at[3] - 36) * long)
    end
    return { radius = radius * mm, points = points }
  end
  return {
    vessel(0.6, enters, { { -9, -15, 5 }, { -14, -10, 11 }, { -16, -8, 19 }, { -14, -7, 28 }, { -13, -8, 40 },
      { -14, -9, 55 }, { -13, -8, 68 } }),
    vessel(0.5, deep_enters or enters, { { -3, -13, 8 }, { -1, -9, 15 }, { 4, -6, 25 }, { 10, -7, 37 },
      { 14, -8, 52 }, { 14, -7, 64 } }),
  }
end

--- A duct or a vessel: a tube through points, as wide as `diameter`, with a wall of that thickness (m), held where
--- `held` says (nil: nowhere); `more` has further keys of the shape, such as nodes, end_radius or carries = "blood".
function anatomy.tube(name, points, diameter, wall, held, more)
  local shape = { type = "tube", points = points, nodes = 9 }
  for key, value in pairs(more or {}) do shape[key] = value end
  if not shape.radii then shape.radius = diameter / 2 end
  return { name = name, shape = shape, wall = soft_wall(wall), held = held }
end
local tube = anatomy.tube

--- The course of a duct or an artery by places relative to one, { left, head, front }, in mm.
local function course(from, places)
  local points = {}
  for k, at in ipairs(places) do points[k] = add(from, at, mm) end
  return points
end

--- One organ's landmark grown to another's, within `radius`: anatomy.joint("duct.end", "gallbladder.neck", 4 * mm).
function anatomy.joint(from, to, radius) return { from = from, to = to, radius = radius } end
local joint = anatomy.joint

--- Those of a list that stay, and whether any does not.
local function keep(list, stays)
  local out = {}
  for _, one in ipairs(list) do
    if stays(one) then out[#out + 1] = one end
  end
  return out, #out < #list
end

--- Takes an organ with what ends on it, or a tissue, out of a field.
local function take_out(field, name, level)
  local function on(landmark) return landmark:match("^[^.]*") == name end
  local organs, was_organ = keep(field.organs, function(organ) return organ.name ~= name end)
  local tissue, was_tissue = keep(field.tissue, function(one)
    return one.name ~= name and one.from ~= name and one.to ~= name
  end)
  if not was_organ and not was_tissue then
    local names, known = {}, {}
    for _, list in ipairs { field.organs, field.tissue } do
      for _, one in ipairs(list) do
        names[#names + 1] = one.name
        known[one.name] = true
      end
    end
    error('the field has no "' .. tostring(name) .. '" to leave out' .. given.suggestion(name, known) .. ": there are "
      .. table.concat(names, ", "), level + 1)
  end
  for _, organ in ipairs(organs) do
    local injury = organ.injury
    if injury and injury.together then
      injury.together = keep(injury.together, function(both) return both.with ~= name end)
    end
  end
  field.organs, field.tissue = organs, tissue
  field.joints = keep(field.joints, function(one) return not on(one.from) and not on(one.to) end)
  field.leaves = keep(field.leaves, function(one) return one.from ~= name and one.to ~= name end)
end

--- From which share of its way to which a tissue or a tube is gone.
local function range_of(name, gone, level)
  local range = type(gone) == "table" and gone or { 0, gone }
  local from, to = tonumber(range[1]), tonumber(range[2])
  if not from or not to or not (from >= 0 and to <= 1 and from < to) or (from > 0 and to < 1) then
    error('what is gone of "' .. name .. '" is a share of its way, 0 to 1, or a range up to one of its ends, '
      .. "such as { 0.5, 1 }", level + 1)
  end
  return from, to
end

--- Clears a tissue from one of its ends on: its way becomes shorter and its strands fewer, each for as much as before.
local function clear(tissue, from, to)
  local start, way = tissue.start or 0, (tissue.stop or 1) - (tissue.start or 0)
  if from == 0 then tissue.start = start + to * way end
  if to == 1 then tissue.stop = start + from * way end
  tissue.strands = math.floor(tissue.strands * (1 - (to - from)) + 0.5)
end

--- Leaves a stump of a tube, which nothing holds where it ends now. Tissue that begins on it has to be gone.
local function leave_stump(field, organ, from, to, level)
  for _, one in ipairs(field.tissue) do
    if one.from == organ.name then
      error('"' .. one.name .. '" begins on "' .. organ.name .. '", of which only a stump is left: name it in without',
        level + 1)
    end
  end
  local shape, points = organ.shape, {}
  local first, last = from == 0 and to or 0, to == 1 and from or 1
  for k = 0, 4 do points[k + 1] = anatomy.along(shape.points, first + k / 4 * (last - first)) end
  local begins, ends = anatomy.radius_along(shape, first), anatomy.radius_along(shape, last)
  shape.points, shape.radii, shape.radius, shape.end_radius = points, nil, begins, ends
  shape.nodes = math.max(5, math.floor(shape.nodes * (last - first) + 0.5))
  local free = from == 0 and "start" or "end"
  local cut_end = organ.name .. "." .. free
  field.joints = keep(field.joints, function(one) return one.from ~= cut_end and one.to ~= cut_end end)
  field.leaves = keep(field.leaves, function(one) return one.from ~= organ.name end)
  organ.held = keep(organ.held or {}, function(one) return one.landmark ~= free end)
end

local function named(list, name)
  for _, one in ipairs(list) do
    if one.name == name then return one end
  end
end

--- Takes out what is gone of tissues and tubes in a field that is prepared.
local function prepare(field, gone_of, level)
  local names = {}
  for name in pairs(gone_of) do names[#names + 1] = name end
  table.sort(names)
  for _, name in ipairs(names) do
    local gone, tissue, organ = gone_of[name], named(field.tissue, name), named(field.organs, name)
    if organ and organ.shape.type ~= "tube" then
      error('"' .. name .. '" is no tissue and no tube: of these a part can be gone', level + 1)
    end
    if not tissue and not organ then take_out(field, name, level + 1) end -- which says that there is none
    if gone ~= 0 then
      local from, to = range_of(name, gone, level + 1)
      if tissue then clear(tissue, from, to) end
      if to - from == 1 or tissue and tissue.strands < 1 then
        take_out(field, name, level + 1)
      elseif organ then
        leave_stump(field, organ, from, to, level + 1)
      end
    end
  end
end

--- What lies around the field, stays, and is touched: drawn by eye. But for the duodenum it is clear of all that moves.
local function surroundings(neck)
  local function capsule(name, looks, from, to, radius)
    return { name = name, type = "capsule", looks = looks, point = from, to = to, radius = radius * mm }
  end
  local function near(x, y, z) return add(neck, { x, y, z }, mm) end
  return {
    capsule("duodenum", "bowel", near(-34, -60, -12), near(60, -62, -6), 13),
    -- Beside the liver's lobe: the round ligament in its fissure, and the left lobe beyond; behind it the right lobe
    -- and, behind the hilum, the caudate lobe.
    capsule("round_ligament", "fat", place(22, -91, -20), place(17, -92, 90), 4),
    capsule("round_ligament_root", "fat", place(22, -91, -20), place(56, -92, -50), 4),
    capsule("left_lobe", "liver", place(49, -123, -30), place(49, -120, 70), 40),
    capsule("right_lobe", "liver", place(62, 8, -48), place(58, 140, -44), 34),
    capsule("caudate_lobe", "liver", place(84, -45, -54), place(84, -130, -48), 40),
    -- The colon's hepatic flexure, and the fat of omentum and retroperitoneum.
    capsule("ascending_colon", "bowel", near(-131, -39, -73), near(-53, -29, -77), 20),
    capsule("transverse_colon", "bowel", near(-53, -29, -77), near(-21, -60, -70), 20),
    capsule("omentum", "fat", near(72, -40, -70), near(173, -22, -52), 22),
    capsule("retroperitoneum", "fat", near(-202, 12, -135), near(206, -14, -120), 45),
    -- What keeps a thing that is laid down from sliding out of the field, to the left and to the feet: the table is
    -- tilted that way.
    capsule("stomach", "bowel", near(137, 59, -61), near(222, -1, -51), 32),
    capsule("descending_colon", "bowel", near(227, 44, -91), near(212, -106, -76), 26),
    capsule("small_bowel", "bowel", near(-118, -86, -136), near(207, -86, -116), 50),
    capsule("ileum", "bowel", near(-118, -136, -91), near(207, -136, -81), 35),
  }
end

--- The cystic plate and what fills the triangle, up to the share of the cystic artery's way at which that turns to the
--- gallbladder's wall (nil: it does not). Nothing of it is calibrated.
local function tissues(p, artery_turns_at)
  local divide = 2.5e6 * p.strength -- J/m^2
  local function count(strands) return math.max(1, math.floor(strands * p.strands + 0.5)) end
  local function with(out, more)
    for key, value in pairs(more or {}) do out[key] = value end
    return out
  end
  local function fat(name, from, to, within, strands, more)
    return with({ name = name, from = from, to = to, within = within, strands = count(strands), slack = 0.2,
      stiffness = 4 * kPa, strength = 12 * kPa * p.strength, break_energy = 200 * p.strength, divide_energy = divide,
      covered = true }, more)
  end
  local function plate(made_of)
    return with({ name = "cystic_plate", from = "gallbladder", to = "liver", within = 7 * mm, start = 0.2 }, made_of)
  end
  return {
    p.areolar_plane
      and plate { strands = count(300), slack = 0.1, stiffness = 8 * kPa, strength = 12 * kPa * p.strength,
        break_energy = 200 * p.strength, divide_energy = 0.1 * divide, looks = "areolar" }
      or plate { strands = count(60), slack = 0.05, stiffness = 20 * kPa, strength = 30 * kPa * p.strength,
        break_energy = 300 * p.strength, divide_energy = divide },
    fat("triangle_fat", "cystic_duct", "common_duct", 14 * mm, 16, { stop = 0.9 }),
    fat("artery_fat", "cystic_artery", "cystic_duct", 18 * mm, 14, { stop = artery_turns_at }),
    fat("hilar_fat", "right_hepatic_artery", "common_duct", 16 * mm, 14, { start = 0.57, stop = 0.86 }),
  }
end

--- The standard field with what differs in its variant, and then what its author gives, if anything, to the function
--- called `owner`. `level`: of error(), as seen from the caller.
local function field_with(owner, variant, overrides, level)
  overrides = overrides or {}
  given.check(overrides, kinds, owner, level + 1)
  local p = {}
  for _, source in ipairs { defaults, variant, overrides } do
    for key, value in pairs(source) do p[key] = value end
  end

  local bladder = gallbladder(p)
  local neck = bladder.shape.along[1].at

  -- The common duct comes from the hilum and goes down in its ligament, behind the duodenum.
  local line = course(neck, {
    { 17, 30, -28 }, { 17, 16, -20 }, { 17, 3, -15 }, { 17, -10, -12 }, { 17, -28, -14 }, { 15, -70, -34 },
  })
  for k, share in ipairs { 0, 0, 0.6, 1, 0.6, 0 } do line[k] = add(line[k], p.union_lies, share) end
  -- Dilated from the hilum, which holds it, to the stone behind the duodenum; the liver's back leaves it more room.
  local radii
  local wider = p.common_duct_widest and (p.common_duct_widest - p.common_duct_diameter) / 2 or 0
  if wider > 0 then
    radii = {}
    for k, share in ipairs { 0, 0.5, 1, 1, 1, 0.2 } do
      radii[k] = p.common_duct_diameter / 2 + share * wider
      if k < 5 then line[k] = add(line[k], towards_fundus, -wider) end
    end
  end
  local common = tube("common_duct", line, p.common_duct_diameter, 1 * mm, {
    { name = "hepatic", landmark = "start", radius = 8 * mm, stiffness = 1e6 },
    { name = "duodenal", landmark = "end", radius = 8 * mm, stiffness = 1e6 },
    { name = "hepatoduodenal_ligament", landmark = "middle", radius = 40 * mm, stiffness = 2e4 },
  }, { nodes = 13, patient_end = "start", radii = radii })
  -- From where the hepatic ducts join, which is where it begins: E3 where no stump is left that is longer than the duct
  -- is wide and could be sewn to (uncalibrated).
  common.injury = { cut = "Strasberg E1", closed = "Strasberg E1", partly = "Strasberg D", near_start = {
    { within = 20 * mm, called = "Strasberg E2" },
    { within = 1.25 * p.common_duct_diameter, called = "Strasberg E3" },
  } }
  common.keep_clear = 3 * mm -- of current; uncalibrated
  local union = anatomy.along(common.shape.points, p.union)

  -- It leaves the neck without a step, and enters the common duct's side.
  local enters = add(union, unit(minus(neck, union)), anatomy.radius_along(common.shape, p.union))
  local begins = add(neck, unit(minus(bladder.shape.along[2].at, neck)), 2.5 * mm)
  local cystic = tube("cystic_duct", bowed(begins, enters, p.cystic_duct_length, unit(add(caudal, back, -0.4))),
    5 * mm, 0.8 * mm, nil, { end_radius = p.cystic_duct_diameter / 2, patient_end = "end", nodes = 11 })
  cystic.injury = { unclipped = "Strasberg A" } -- its stump leaks

  -- What else brings bile down: where it lies in the liver it is held.
  local ducts, duct_joints = {}, {}
  local function hepatic_duct(name, points, diameter, enters_at)
    local duct = tube(name, points, diameter, 0.8 * mm, {
      { name = "hilum", landmark = "start", radius = 5 * mm, stiffness = 1e6 },
    }, { patient_end = "start" })
    duct.keep_clear = 3 * mm
    ducts[#ducts + 1] = duct
    duct_joints[#duct_joints + 1] = joint(name .. ".end", enters_at, 4 * mm)
    return duct
  end
  if p.hepatic_ducts then
    local confluence = line[1]
    -- E4: once one of them is cut off, right and left do not communicate.
    for _, duct in ipairs { { "right", { 6, 7.5, -3 } }, { "left", { 8, -15, -3 } } } do
      local side, way = duct[1], minus(place(table.unpack(duct[2])), bed_neck)
      local points = { add(confluence, way), add(confluence, way, 0.1) }
      hepatic_duct(side .. "_hepatic_duct", points, 4 * mm, "common_duct.start").injury =
        { cut = "Strasberg E4", closed = "Strasberg E4", partly = "Strasberg D" }
    end
    duct_joints[#duct_joints + 1] = joint("right_hepatic_duct.end", "left_hepatic_duct.end", 3 * mm)
  end
  if p.aberrant_duct then
    local joins = anatomy.along(common.shape.points, p.aberrant_union)
    local comes = course(neck, { { -3, 21, -35.5 }, { 6, 17, -25 } })
    local touches = add(joins, unit(minus(comes[2], joins)), anatomy.radius_along(common.shape, p.aberrant_union))
    local way = { comes[1], comes[2], touches }
    local aberrant = hepatic_duct("aberrant_right_duct", way, 2.6 * mm, "common_duct.middle")
    -- A part of the liver drains by it alone: shut it is B, open towards the liver C.
    aberrant.injury = { closed = "Strasberg B", unclipped = "Strasberg C", partly = "aberrant right duct injured",
      together = {} }
    for _, main in ipairs { common, table.unpack(ducts, 1, #ducts - 1) } do
      main.injury.together = { { with = aberrant.name, called = "Strasberg E5" } }
      table.insert(aberrant.injury.together, { with = main.name, called = "Strasberg E5" })
    end
  end

  -- Up beside the bile duct, behind the hepatic duct, through the triangle's top, and behind the liver's edge. From the
  -- triangle's top on the hilum holds it.
  local behind = add({ 17, 5, -23.5 }, add(times(towards_fundus, -1), back, 1.8), wider / mm)
  local to_hilum = { { 6, 3.5, -14 }, { 4, 10, -26 }, { 3, 15.5, -34 }, { 5, 25, -40 } }
  if p.hepatic_artery_near_neck then
    to_hilum = { { 11, 5, -22 }, { 5, 1, -12 }, { 5, 8, -24 }, { 5, 13.5, -32 }, { 6, 24, -39 } }
  end
  local hepatic_artery = tube("right_hepatic_artery", course(neck, {
    { 30, -86, -44 }, { 30, -66, -36 }, { 29, -18, -17 }, { 25, 0, -19 }, behind, table.unpack(to_hilum),
  }), 3.4 * mm, 0.8 * mm, {
    { name = "proper_hepatic_artery", landmark = "start", radius = 8 * mm, stiffness = 1e6 },
    { name = "ligament", landmark = "middle", radius = 14 * mm, stiffness = 5e4 },
    { name = "hilum", landmark = "end", radius = 28 * mm, stiffness = 1e6 },
  }, { nodes = 21, patient_end = "start", carries = "blood" })
  hepatic_artery.injury = {
    cut = "right hepatic artery divided",
    closed = "right hepatic artery closed",
    partly = "right hepatic artery injured",
  }

  local bed_width = math.max(35 * mm, 2 * p.gallbladder_width - 31 * mm)
  local organs = { bladder, {
    name = "liver", neck = bed_neck, fundus = bed_fundus, liver_side = liver_side,
    shape = { type = "lobe", depth = 70 * mm, bed_length = 80 * mm, bed_width = bed_width },
  }, common, cystic, hepatic_artery }
  local joints = {
    joint("cystic_duct.start", "gallbladder.neck", 4 * mm),
    joint("cystic_duct.end", "common_duct.middle", 4 * mm),
  }

  --- From a share of the hepatic artery's way to a place, from which it turns to the gallbladder's wall where it is off
  --- that. Returns the share of its own way at which it turns; nil: nowhere.
  local function cystic_artery(name, share, to)
    local from = anatomy.along(hepatic_artery.shape.points, share)
    local way = unit(minus(to, from))
    local points = bowed(add(from, way, 1.7 * mm), to, p.cystic_artery_length, unit(add(towards_liver, aside, 0.5)))
    local wall, gap = on_wall(bladder.shape, to)
    local turns = gap > 0.5 * mm
    if turns then points[#points + 1] = wall end
    organs[#organs + 1] =
      tube(name, points, p.cystic_artery_diameter, 0.4 * mm, nil, { patient_end = "start", carries = "blood" })
    joints[#joints + 1] = joint(name .. ".start", "right_hepatic_artery.middle", 3 * mm)
    joints[#joints + 1] = joint(name .. ".end", "gallbladder.neck", 4 * mm)
    return turns and p.cystic_artery_length / (p.cystic_artery_length + gap) or nil
  end
  local turns_at = cystic_artery("cystic_artery", 0.745, place(table.unpack(p.cystic_artery_enters)))
  bladder.vessels = branches(p, p.cystic_artery_enters, p.second_cystic_artery and second_enters)

  -- The node lies between neck and artery, fast to the neck by all of its skin. It gives way as lymph nodes do (20 to
  -- 80 kPa, uncalibrated): a stone there would cost the solver half of its time to turn.
  local radius = p.node_diameter / 2
  local on_neck, outward = place(-1.4, -18, 3), unit(minus(place(1, -18, 2.5), place(-5, -18, 3.5)))
  organs[#organs + 1] = { name = "cystic_node",
    shape = { type = "rigid", rounding = radius, centre = add(on_neck, outward, radius + 0.8 * mm), density = 1050,
      stiffness = 80 * kPa } }
  joints[#joints + 1] = joint("cystic_node.centre", "gallbladder.neck", 3 * radius)
  for _, duct in ipairs(ducts) do organs[#organs + 1] = duct end
  for _, one in ipairs(duct_joints) do joints[#joints + 1] = one end
  if p.second_cystic_artery then cystic_artery("second_cystic_artery", 0.81, place(table.unpack(second_enters))) end

  local field = {
    organs = organs,
    joints = joints,
    -- Over duct and artery in their ligament, below where the cystic duct enters.
    leaves = {
      { from = "common_duct", to = "right_hepatic_artery", start = math.min(p.union + 0.06, 0.95), goes_on = 14 * mm },
    },
    tissue = tissues(p, turns_at),
    ground = surroundings(neck),
  }
  for _, name in ipairs(p.without) do
    if p.prepared[name] ~= nil then error('"' .. name .. '" is in prepared and in without', level + 1) end
  end
  for _, name in ipairs(p.without) do take_out(field, name, level + 1) end
  prepare(field, p.prepared, level + 1)
  return field
end

--- The anatomy of a standard field, or with other lengths: see the top of this file.
function anatomy.standard(overrides)
  local field = field_with("anatomy.standard", {}, overrides, 2)
  return field -- not at once: who is called last has no line of its caller
end

--- What differs from the standard field, by name; how often it is seen, as published.
anatomy.variants = {
  short_cystic_duct = { cystic_duct_length = 9 * mm, union = 0.4, union_lies = { -9 * mm, 1 * mm, 6 * mm } }, -- 15 %
  low_union = { union = 0.62, cystic_duct_length = 36 * mm }, -- 3 to 11 %
  double_cystic_artery = { second_cystic_artery = true }, -- 13 %
  hepatic_artery_near_neck = { hepatic_artery_near_neck = true }, -- "caterpillar turn"; uncalibrated
  hydrops = { gallbladder_length = 90 * mm, gallbladder_width = 36 * mm, fill_pressure = 20 * mmHg, looks = "pale" },
  phrygian_cap = { phrygian_cap = true }, -- about 4 %
  dilated_common_duct = { common_duct_widest = 10 * mm }, -- with a stone in it; uncalibrated
  aberrant_right_duct = { aberrant_duct = true, hepatic_ducts = true }, -- uncalibrated
}

--- The standard field with what a variant changes, and then with what differs besides.
function anatomy.variant(name, overrides)
  if type(name) ~= "string" then error('anatomy.variant takes a name first, such as "low_union"', 2) end
  local changes = anatomy.variants[name]
  if changes == nil then
    local names = {}
    for known in pairs(anatomy.variants) do names[#names + 1] = known end
    table.sort(names)
    error('no variant "' .. name .. '"' .. given.suggestion(name, anatomy.variants) .. ": there are "
      .. table.concat(names, ", "), 2)
  end
  local field = field_with("anatomy.variant", changes, overrides, 2)
  return field
end

--- The standard field with lengths drawn from about the published ranges, as far as they fit this field, by the
--- scenario's own random numbers (calot run --seed N): the same seed, the same patient.
function anatomy.varied(overrides)
  local function between(low, high) return low + (high - low) * math.random() end
  local drawn = {
    gallbladder_length = between(74, 88) * mm,
    gallbladder_width = between(30, 35) * mm,
    fill_pressure = between(10, 15) * mmHg,
    cystic_duct_length = between(18, 28) * mm,
    cystic_duct_diameter = between(2.6, 4.4) * mm,
    common_duct_diameter = between(5, 6) * mm,
    cystic_artery_diameter = between(1.2, 2) * mm,
    second_cystic_artery = math.random() < 0.13,
    phrygian_cap = math.random() < 0.04,
  }
  local field = field_with("anatomy.varied", drawn, overrides, 2)
  return field
end

-- ---- what they take

local function of(name) return { name, given.number } end
for name, takes in pairs {
  along = { { "points", given.points }, { "share", given.share } },
  radius_along = { { "shape", given.by_name }, { "share", given.share } },
  place = { of "x", of "y", of "z" },
  tube = { { "name", given.name }, { "points", given.points }, { "diameter", given.optional(up_to(100)) },
    { "wall", up_to(20) }, { "held", given.optional(given.list) }, { "more", given.optional(given.by_name) } },
  joint = { { "from", given.name }, { "to", given.name }, { "radius", up_to(100) } },
} do anatomy[name] = given.checked("anatomy." .. name, takes, anatomy[name]) end

return anatomy
