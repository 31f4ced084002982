-- A training box: a ring is lifted off one peg with the left hand, handed over in the air, and put over another peg
-- with the right one. The mistake is a parameter, demo = "clumsy": the left hand lets go before the right one holds.

local calot = require "calot"
local technique = require "technique"
local mm, s, N, deg = calot.units.mm, calot.units.s, calot.units.N, calot.units.deg
local plus, minus, unit, length = technique.plus, technique.minus, technique.unit, technique.length

local board = -120 * mm
local rod = 2.5 * mm -- radius of what the ring is bent from
local peg_height = 18 * mm
local first = { -74 * mm, 95 * mm, board }
local second = { -36 * mm, 95 * mm, board }
local ports = { left = { -115 * mm, 60 * mm, -5 * mm }, right = { 5 * mm, 60 * mm, -5 * mm } }

local function peg(name, foot)
  return {
    name = name,
    type = "capsule",
    point = foot,
    to = plus(foot, { 0, 0, peg_height }),
    radius = 2.5 * mm,
    friction = 0.2,
    looks = "board",
  }
end

--- How often the ring came down on the board.
local function judge_drops(run)
  local drops = run.notes.drops or 0
  return math.max(0, 1 - 0.5 * drops), drops == 0 and "the ring never fell"
    or ("the ring fell %d times; each takes half"):format(drops)
end

return calot.exercise {
  api = 2,
  id = "peg-transfer",
  title = "A ring is handed over from peg to peg",
  time_limit = 90 * s,

  params = {
    demo = {
      type = "choice",
      default = "expert",
      choices = { "expert", "clumsy" },
      title = "how the demo hands it over: held by both hands, or dropped between them",
    },
  },

  scene = function()
    return {
      anatomy = {
        table_head_up = 0,
        table_left_down = 0,
        friction = 0.3,
        ground = {
          { name = "board", point = { 0, 0, board }, friction = 0.4, looks = "board" },
          peg("first_peg", first),
          peg("second_peg", second),
        },
        organs = {
          {
            name = "ring",
            shape = {
              type = "rigid",
              ring = 11 * mm,
              rounding = rod,
              centre = plus(first, { 0, 0, rod + 0.3 * mm }),
              density = 1100,
            },
            looks = "plastic",
          },
        },
      },
      ports = { scope = { -55 * mm, -10 * mm, 10 * mm }, port_left = ports.left, port_right = ports.right },
      instruments = {
        -- A push on the board hurts nobody.
        left = { port = "port_left", type = "maryland_dissector", force_limit = 30 * N },
        right = { port = "port_right", type = "maryland_dissector", force_limit = 30 * N },
      },
      laparoscope = { port = "scope", angle = 30 * deg, look_at = "ring.centre", distance = 115 * mm },
      solver = { motion = "dynamic" },
    }
  end,

  steps = function(t)
    local function over(foot)
      local at = t:place("ring.centre")
      return length({ at[1] - foot[1], at[2] - foot[2], 0 }) < 6 * mm
    end
    --- Whether it is done; counts how often the ring comes down elsewhere than round the second peg.
    local drops, lifted = 0, false
    t:note("drops", drops)
    local function watched(is_done)
      return function()
        local height = t:place("ring.centre")[3] - board
        if lifted and height < 8 * mm and not over(second) then
          drops = drops + 1
          t:note("drops", drops)
        end
        lifted = height > 12 * mm or lifted and height > 8 * mm
        return is_done()
      end
    end

    t:step("lift", "Lift the ring off its peg with the left hand", {
      limit = 30 * s,
      hint = "jaws across its rim, then straight up; both hands begin beside the board",
    })
    t:wait_until(watched(function()
      return t.left:holds("ring") and t:place("ring.centre")[3] > board + peg_height + 12 * mm
    end))
    t:step("hand_over", "Hand it over to the right hand, in the air", {
      limit = 30 * s,
      hint = "the right hand takes the rim opposite; only when it holds does the left one open",
    })
    t:wait_until(watched(function() return t.right:holds("ring") and not t.left:holds() end))
    t:step("put_over", "Put it over the other peg", { limit = 30 * s, hint = "lower it round the peg, then open" })
    t:wait_until(watched(function()
      return not t.right:holds() and over(second) and t:place("ring.centre")[3] < board + 8 * mm
    end))
    t:wait(0.4 * s)
  end,

  demo = function(t, p)
    --- Open jaws come about the rim at one of its places, their tips that far past its middle, and close.
    local function take(hand, name, at, past)
      local along = minus(t:place("ring.rim_2"), t:place("ring.rim_4"))
      local place = t:place(at)
      hand:rotate(technique.roll_across(ports[name], place, unit(along)), { speed = 300 * deg / s })
      hand:open(24 * deg)
      local back = unit(minus(ports[name], place))
      hand:move_to(plus(place, back, 20 * mm), { speed = 120 * mm / s })
      hand:move_to(plus(t:place(at), back, -past), { speed = 40 * mm / s })
      hand:close()
    end
    --- The ring's middle is carried to a place.
    local function carry(hand, to, speed) hand:move_by(minus(to, t:place("ring.centre")), { speed = speed }) end

    take(t.left, "left", "ring.rim_3", 1 * mm)
    carry(t.left, plus(first, { 0, 0, peg_height + 16 * mm }), 60 * mm / s)
    carry(t.left, plus(first, { 19 * mm, -5 * mm, peg_height + 20 * mm }), 60 * mm / s)
    if p.demo == "clumsy" then t.left:open() end
    take(t.right, "right", "ring.rim_1", 3 * mm)
    t.left:open(26 * deg)
    t.left:move_by({ -20 * mm, -10 * mm, 12 * mm }, { speed = 60 * mm / s })
    carry(t.right, plus(second, { 0, 0, peg_height + 16 * mm }), 60 * mm / s)
    carry(t.right, plus(second, { 0, 0, rod + 9 * mm }), 40 * mm / s)
    t.right:open(26 * deg)
    t.right:move_by({ 8 * mm, -6 * mm, 26 * mm }, { speed = 80 * mm / s })
    t:wait(1 * s)
  end,

  score = calot.score.weighted {
    { calot.score.time { reference = 15 * s, limit = 60 * s }, weight = 0.3 },
    { calot.score.rule(judge_drops), name = "drops", weight = 0.4 },
    { calot.score.benchmark { metric = "right.path_length_mm", novice = 500, expert = 180 }, weight = 0.1 },
    { calot.score.benchmark { metric = "left.path_length_mm", novice = 500, expert = 180 }, weight = 0.1 },
    { calot.score.penalty { event = "empty_grasp", each = 0.25 }, weight = 0.1 },
    pass = 70,
  },

  golden = { at = { 0, 2.8 * s, 3.48 * s, 6.9 * s, 8.7 * s, 10 * s } },
}
