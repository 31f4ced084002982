-- What authors give to a module's function in a table, checked all at once at the author's line.
--
--   local given = require "given"
--   local wanted = { port = given.three, tries = given.whole, wanted = given.optional(given.called) }
--   function module.take(how) given.check(how, wanted, "module.take", 2) ... end

local calot = require "calot"

local given = {}

local function finite(value) return type(value) == "number" and value == value and math.abs(value) < math.huge end

--- A table of `count` entries 1, 2, ... (nil: of any number) that all pass.
local function all_pass(value, count, passes)
  if type(value) ~= "table" or (count and #value ~= count) then return false end
  for key, entry in pairs(value) do
    if math.type(key) ~= "integer" or not passes(entry) then return false end
  end
  return true
end

local function is_a(kind) return function(value) return type(value) == kind end end

-- ---- kinds of value: what it is to be, and whether it is that

given.number = { is = "a number", fits = finite }
--- A number between two limits, in words and with what a value beyond them may have been meant as, such as
--- given.between(0, 0.2, "a length above 0, up to 200 mm", "mm").
function given.between(low, high, is, unit)
  return {
    is = is, unit = unit, fits = function(value) return finite(value) and value > low and value <= high end,
  }
end
given.above_zero = { is = "a number above 0", fits = function(value) return finite(value) and value > 0 end }
given.part = {
  is = "a share between 0 and 1", fits = function(value) return finite(value) and value > 0 and value < 1 end,
}
given.whole = {
  is = "a whole number above 0", fits = function(value) return math.type(value) == "integer" and value > 0 end,
}
given.three = { is = "three numbers { x, y, z }", fits = function(value) return all_pass(value, 3, finite) end }
given.way = { is = "three numbers { x, y, z }, not all 0", fits = function(value)
  return given.three.fits(value) and (value[1] ~= 0 or value[2] ~= 0 or value[3] ~= 0)
end }
given.points = { is = "a list of two places or more { { x, y, z }, ... }", fits = function(value)
  return all_pass(value, nil, given.three.fits) and #value > 1
end }
given.share = {
  is = "a share of a way, 0 to 1", fits = function(value) return finite(value) and value >= 0 and value <= 1 end,
}
given.shares = {
  is = "a list of shares { ... }, each 0 to 1",
  fits = function(value) return all_pass(value, nil, given.share.fits) and #value > 0 end,
}
given.yes_or_no = { is = "true or false", fits = is_a "boolean" }
given.name = { is = "a name in quotes", fits = is_a "string" }
given.names = {
  is = 'a list of names { "..." }', fits = function(value) return all_pass(value, nil, is_a "string") end,
}
given.two_names = {
  is = 'two names { "...", "..." }', fits = function(value) return all_pass(value, 2, is_a "string") end,
}
given.list = { is = "a list { ... }", fits = function(value)
  return all_pass(value, nil, function() return true end)
end }
given.by_name = { is = "a table of what has names, { name = ..., ... }", fits = function(value)
  if type(value) ~= "table" then return false end
  for name in pairs(value) do
    if type(name) ~= "string" then return false end
  end
  return true
end }
given.called = { is = "a function", fits = is_a "function" }
given.exercise = { is = "the exercise's t", fits = is_a "userdata" }
given.tool = { is = "an instrument, such as t.left", fits = is_a "userdata" }
given.run = { is = "the run that a rule is given", fits = is_a "table" }

--- That kind of value, or none.
function given.optional(kind) return { is = kind.is, fits = kind.fits, unit = kind.unit, may_be_missing = true } end

--- That kind of value, or false.
function given.or_false(kind)
  return { is = kind.is .. ", or false", fits = function(value) return value == false or kind.fits(value) end }
end

-- ---- names

--- How many letters differ, are missing, or are too many.
local function edits(a, b)
  local row = {}
  for j = 0, #b do row[j] = j end
  for i = 1, #a do
    local before = row[0]
    row[0] = i
    for j = 1, #b do
      local same = a:byte(i) == b:byte(j) and before or before + 1
      before = row[j]
      row[j] = math.min(same, row[j] + 1, row[j - 1] + 1)
    end
  end
  return row[#b]
end

--- ' (did you mean "..."?)', of the names that are keys of `known`; '' where none is near.
function given.suggestion(name, known)
  local best, fewest = nil, 4
  for key in pairs(known) do
    local far = type(key) == "string" and edits(tostring(name), key) or fewest + 1
    if far < fewest or far == fewest and best and key < best then best, fewest = key, far end
  end
  return best and fewest <= #best / 2 and ' (did you mean "' .. best .. '"?)' or ""
end

--- A module of that name: what it does not have is refused where it is asked for.
function given.module(name)
  return setmetatable({}, { __index = function(module, key)
    calot.refuse(name .. " has no " .. tostring(key) .. given.suggestion(key, module), 2)
  end })
end

-- ---- checks

local function shown(value)
  if value ~= value then return "nan" end
  if type(value) == "table" or type(value) == "function" then return "this " .. type(value) end
  if type(value) == "userdata" then return "this" end
  return type(value) == "string" and '"' .. value .. '"' or tostring(value)
end

--- What is wrong with a value; nil: nothing.
local function fault(name, value, kind)
  if kind.fits(value) then return nil end
  local said = name .. " is " .. kind.is .. ", not " .. shown(value)
  if kind.unit and finite(value) and value > 0 then
    said = said .. string.format(" (did you mean %g * %s?)", value, kind.unit)
  end
  return said
end

--- Whether a function that is called `owner` was called by a colon: its first argument then is what it is a member of.
local function called_by_colon(owner, first)
  return type(first) == "table" and rawget(first, owner:match "[^.]*$") ~= nil
end
local by_colon = "call it with a dot, not with a colon"

--- Refuses all at once what `owner`, the name of a function or of one of its parameters, does not have, what is no
--- value of its kind, and what is missing. `kinds`: by key. `level`: of calot.refuse(), as seen from the caller.
function given.check(values, kinds, owner, level)
  if called_by_colon(owner, values) then calot.refuse(owner .. ": " .. by_colon, level + 1) end
  if type(values) ~= "table" then
    calot.refuse(owner .. " takes a table of parameters, not " .. shown(values), level + 1)
  end
  local wrong = {}
  for key, value in pairs(values) do
    local kind = kinds[key]
    if kind == nil then
      wrong[#wrong + 1] = owner .. ' has no parameter "' .. tostring(key) .. '"' .. given.suggestion(key, kinds)
    else
      wrong[#wrong + 1] = fault(key, value, kind)
    end
  end
  for key, kind in pairs(kinds) do
    if not kind.may_be_missing and rawget(values, key) == nil then
      wrong[#wrong + 1] = owner .. " needs " .. key .. ", " .. kind.is
    end
  end
  table.sort(wrong)
  if #wrong > 0 then calot.refuse(table.concat(wrong, "; "), level + 1) end
end

local function pass(...) return ... end

--- `does` as authors call it: refuses at their line arguments that are none of their kind, missing or too many.
--- `takes`: { { name, kind }, ... } in their order.
function given.checked(owner, takes, does)
  return function(...)
    local count = select("#", ...)
    local wrong = {}
    for k, one in ipairs(takes) do
      local value = (select(k, ...))
      if value ~= nil or not one[2].may_be_missing then wrong[#wrong + 1] = fault(one[1], value, one[2]) end
    end
    if count > #takes then wrong[#wrong + 1] = #takes .. " arguments are enough, not " .. count end
    if #wrong > 0 then
      local said = called_by_colon(owner, (...)) and by_colon or table.concat(wrong, "; ")
      calot.refuse(owner .. ": " .. said, 2)
    end
    return pass(does(...)) -- not at once: who is called last has no line of its caller
  end
end

return given
