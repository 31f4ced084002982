-- Calot's triangle is dissected to the critical view of safety: the tissue between cystic duct and cystic artery is
-- taken with the hook until the liver is seen behind them, and the gallbladder's lower part comes off the cystic plate,
-- so that two structures and no more are seen to enter the gallbladder. The field is prepared: fat at the hilum and
-- most of that beside the common duct is gone. The mistakes are a parameter, demo = "clumsy": current in the air, and
-- an end before the view is there.

local calot = require "calot"
local anatomy = require "anatomy"
local mm, s, N, deg = calot.units.mm, calot.units.s, calot.units.N, calot.units.deg

local function plus(a, b, share)
  share = share or 1
  return { a[1] + share * b[1], a[2] + share * b[2], a[3] + share * b[3] }
end
local function length(a) return math.sqrt(a[1] ^ 2 + a[2] ^ 2 + a[3] ^ 2) end
local function unit(a) return plus({ 0, 0, 0 }, a, 1 / length(a)) end

local hook_port = { -10 * mm, 120 * mm, -5 * mm }
local lower_part = 0.4 -- of the gallbladder's way: its lower third in this field, from where its bed begins

-- Calot's own triangle, whose upper side is the cystic artery: there is the tissue.
local function view(t) return t:critical_view { hilum = "cystic_artery.start", lower_part = lower_part } end

local function note(t, when)
  local now = view(t)
  t:note("critical_view" .. when, now.points)
  t:note("front_pct" .. when, 100 * now.triangle.front, "%")
  t:note("behind_pct" .. when, 100 * now.triangle.behind, "%")
  t:note("plate_pct" .. when, 100 * now.plate.share, "%")
  t:note("free_structures" .. when, now.structures.free)
end

return calot.exercise {
  api = 1,
  id = "dissect-to-critical-view",
  title = "Dissect to the critical view of safety",
  time_limit = 120 * s,

  params = {
    demo = {
      type = "choice",
      default = "expert",
      choices = { "expert", "clumsy" },
      title = "how the demo goes about it: strand by strand with the hook, or hastily",
    },
  },

  scene = function()
    return {
      anatomy = anatomy.standard {
        cystic_artery_enters = { -2, -17, 10 },
        cystic_artery_length = 24 * mm,
        without = { "cystic_node", "hilar_fat" },
        prepared = { triangle_fat = 0.75 },
      },
      ports = { scope = { -40 * mm, 20 * mm, 10 * mm } },
      instruments = {
        left = { port = "right_subcostal", force_limit = 5 * N },
        hook = { type = "l_hook", port = "epigastric", force_limit = 3 * N, power = 40 },
      },
      laparoscope = { port = "scope", angle = 30 * deg, look_at = "cystic_duct.middle", distance = 75 * mm },
      solver = { motion = "dynamic" },
    }
  end,

  steps = function(t)
    t:step("expose", "Draw the pouch to the side and down", {
      limit = 15 * s,
      hint = "Hartmann's pouch to the patient's right and down opens the triangle between duct and artery",
    })
    t:wait_until(function() return t.left:holds("gallbladder") end)
    t:wait(1.5 * s)
    note(t, "_before")
    t:step("triangle", "Clear the triangle between duct and artery with the hook", {
      limit = 30 * s,
      hint = "lay the hook on a strand, let current flow until it parts, and go to the next; keep off the duct",
    })
    t:wait_until(function() return t:torn("artery_fat") == 1 end)
    t:step("plate", "Take the gallbladder's lower part off the cystic plate", {
      limit = 40 * s,
      hint = "where the lowest lobules of fat join gallbladder and liver, from the triangle's side",
    })
    t:wait_until(function() return view(t).plate.points > 0 end)
    t:wait(0.8 * s)
    note(t, "")
  end,

  demo = function(t, p)
    local function next_strand(tissue, wanted)
      local tip, best = t.hook:tip(), nil
      for _, strand in ipairs(t:strands(tissue)) do
        local far = length(plus(strand.middle, tip, -1))
        if wanted(strand) and (not best or far < best.far) then best = { at = strand.middle, far = far } end
      end
      return best
    end

    -- The hook's foot comes down on a strand, and current flows until one has parted; else it comes down nearer to its
    -- heel.
    local reach = { 4 * mm, 2 * mm, 0.5 * mm }
    local function take(tissue, wanted, tries, hardest, is_done)
      local missed = 0
      while missed < 9 do
        local strand = next_strand(tissue, wanted)
        if not strand or is_done() then return end
        local back = unit(plus(hook_port, strand.at, -1))
        local aim = plus(strand.at, { reach[missed % 3 + 1], 0, 0 })
        t.hook:move_to(plus(aim, back, 5 * mm), { speed = 80 * mm / s })
        local function lies_on_it()
          local contact = t.hook:contact()
          return contact ~= nil and contact.organ == tissue or t.hook:force() > hardest
        end
        t.hook:move_until(lies_on_it, { along = plus({ 0, 0, 0 }, back, -1), speed = 25 * mm / s, limit = 8 * mm })
        local standing = #t:strands(tissue)
        for _ = 1, tries do
          if not t.hook:touching() or #t:strands(tissue) < standing then break end
          t.hook:activate(0.1 * s)
        end
        missed = #t:strands(tissue) < standing and 0 or missed + 1
        t.hook:move_by(plus({ 0, 0, 0 }, back, 5 * mm), { speed = 80 * mm / s })
      end
    end

    t:together(function()
      t.left:approach("gallbladder.infundibulum", { speed = 60 * mm / s, depth = 3.5 * mm })
      t.left:close()
      t.left:move_by({ -14 * mm, -13 * mm, 3 * mm }, { speed = 15 * mm / s })
    end, function()
      t.hook:rotate(180 * deg, { speed = 400 * deg / s }) -- its foot points to the patient's right
      t.hook:move_to({ -30 * mm, 120 * mm, -80 * mm }, { speed = 60 * mm / s })
    end)
    t.left:wait(0.3 * s)
    if p.demo == "clumsy" then t.hook:activate(0.5 * s) end
    take("artery_fat", function() return true end, 6, 0.4 * N, function()
      return p.demo == "clumsy" and t:torn("artery_fat") > 0.2
    end)
    if p.demo == "clumsy" then return end
    take("cystic_plate", function(strand) return strand.share <= lower_part end, 30, 1 * N, function()
      return view(t).plate.points > 0
    end)
    t.hook:move_by({ 10 * mm, 0, 40 * mm }, { speed = 100 * mm / s })
  end,

  score = calot.score.weighted {
    { calot.score.benchmark { metric = "note.critical_view", novice = 0, expert = 5 }, weight = 0.7 },
    { calot.score.benchmark { metric = "hook.peak_force_N", novice = 3, expert = 1.5 }, weight = 0.15 },
    { calot.score.penalty { event = "dry_activation", each = 0.25 }, weight = 0.15 },
    critical = { "overforce", "perforation" },
    cap = 40,
    pass = 80,
  },

  golden = { at = { 3.6 * s, 12 * s, 24 * s, 29.4 * s } },
}
