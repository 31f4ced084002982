-- What authors give to a module's function in a table, checked all at once at the author's line.
--
--   local given = require "given"
--   local wanted = { port = given.three, tries = given.whole, wanted = given.optional(given.called) }
--   function module.take(how) given.check(how, wanted, "module.take", 2) ... end

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
given.numbers = {
  is = "a list of numbers { ... }", fits = function(value) return all_pass(value, nil, finite) and #value > 0 end,
}
given.above_zero = { is = "a number above 0", fits = function(value) return finite(value) and value > 0 end }
given.part = {
  is = "a share between 0 and 1", fits = function(value) return finite(value) and value > 0 and value < 1 end,
}
given.whole = {
  is = "a whole number above 0", fits = function(value) return math.type(value) == "integer" and value > 0 end,
}
given.three = { is = "three numbers { x, y, z }", fits = function(value) return all_pass(value, 3, finite) end }
given.yes_or_no = { is = "true or false", fits = is_a "boolean" }
given.name = { is = "a name in quotes", fits = is_a "string" }
given.names = {
  is = 'a list of names { "..." }', fits = function(value) return all_pass(value, nil, is_a "string") end,
}
given.by_name = { is = "a table by names", fits = function(value)
  if type(value) ~= "table" then return false end
  for name in pairs(value) do
    if type(name) ~= "string" then return false end
  end
  return true
end }
given.called = { is = "a function", fits = is_a "function" }

--- That kind of value, or none.
function given.optional(kind) return { is = kind.is, fits = kind.fits, may_be_missing = true } end

--- That kind of value, or false.
function given.or_false(kind)
  return { is = kind.is .. ", or false", fits = function(value) return value == false or kind.fits(value) end }
end

-- ---- checks

local function shown(value)
  if value ~= value then return "nan" end
  if type(value) == "table" or type(value) == "function" then return "this " .. type(value) end
  return type(value) == "string" and '"' .. value .. '"' or tostring(value)
end

--- Refuses all at once what `owner`, the name of a function or of one of its parameters, does not have, what is no
--- value of its kind, and what is missing. `kinds`: by key. `level`: of error(), as seen from the caller.
function given.check(values, kinds, owner, level)
  if type(values) ~= "table" then error(owner .. " takes a table of parameters, not " .. shown(values), level + 1) end
  local wrong = {}
  for key, value in pairs(values) do
    local kind = kinds[key]
    if kind == nil then
      wrong[#wrong + 1] = owner .. ' has no parameter "' .. tostring(key) .. '"'
    elseif not kind.fits(value) then
      wrong[#wrong + 1] = key .. " is " .. kind.is .. ", not " .. shown(value)
    end
  end
  for key, kind in pairs(kinds) do
    if values[key] == nil and not kind.may_be_missing then
      wrong[#wrong + 1] = owner .. " needs " .. key .. ", " .. kind.is
    end
  end
  table.sort(wrong)
  if #wrong > 0 then error(table.concat(wrong, "; "), level + 1) end
end

return given
