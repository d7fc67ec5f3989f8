-- SPDX-License-Identifier: MIT
-- The visor in a fight: hits bend it and part its colours, shots part them a little, quad damage makes them pulse, low
-- health bends it for as long as it lasts. All of these add up, over what the look and the console say. Reads of `game`:
-- health, intermission, face_pain, fire_flash and has_quad; see docs/controllers.md.

-- Seconds, and what is added at the first moment; it falls to nothing along a line.
local hit = { duration = 0.4, warp = -0.15, chroma = 0.012 }
local shot = { duration = 0.15, chroma = 0.003 }
local quad = { chroma = 0.004, rate = 6, fade = 0.4 }
local low = { health = 25, warp = -0.1 }
engine.pre_roll(0.5)  -- longer than any of these lasts

local function decay(start, duration, now)
    local t = start and (now - start) / duration or 1
    return (t >= 0 and t < 1) and 1 - t or 0
end

-- What was set last, as text: a frame that changes nothing sets nothing. A stack may lack the variable.
local last = {}

local function set(name, base, value)
    local text = string.format("%.6f", value)
    if text ~= (last[name] or string.format("%.6f", base)) and engine.cvar_get(name) ~= "" then
        engine.cvar_set(name, text)
    end
    last[name] = text
end

local hit_at, shot_at, quad_ended_at
local was_in_pain, was_firing, had_quad = false, false, false

engine.on_frame("combat", function()
    -- Base values, never what this script made of them: a change in the console counts at once.
    local warp, chroma = engine.cvar_get_number("r_ui_warp"), engine.cvar_get_number("r_ui_chromatic")
    local echo = engine.cvar_get_number("r_ui_echo")
    local now, health = engine.time(), game.health or 100

    set("r_ui_echo", echo, engine.hud_visible() and echo or 0)
    if game.intermission or health <= 0 then
        hit_at, shot_at = nil, nil
        set("r_ui_warp", warp, warp)
        set("r_ui_chromatic", chroma, chroma)
        return
    end

    if game.face_pain and not was_in_pain then hit_at = now end
    if game.fire_flash and not was_firing then shot_at = now end
    if had_quad and not game.has_quad then quad_ended_at = now end
    was_in_pain, was_firing, had_quad = game.face_pain, game.fire_flash, game.has_quad

    local of_hit = decay(hit_at, hit.duration, now)
    local of_quad = game.has_quad and (math.sin(quad.rate * now) + 1) / 2 or decay(quad_ended_at, quad.fade, now)
    local of_low = health < low.health and 1 - health / low.health or 0
    set("r_ui_warp", warp, warp + hit.warp * of_hit + low.warp * of_low)
    set("r_ui_chromatic", chroma, chroma + hit.chroma * of_hit + shot.chroma * decay(shot_at, shot.duration, now) +
        quad.chroma * of_quad)
end)
