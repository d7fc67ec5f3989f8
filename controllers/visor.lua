-- SPDX-License-Identifier: MIT
-- The visor's echo, by context: faint behind the game, stronger behind a menu.

local echo_in_game, echo_in_menu, echo_scale = 0.1, 0.2, 1.01

-- What was set last, as text: a frame that changes nothing sets nothing. A stack may lack the variable.
local last = {}

local function set(name, value)
    local text = string.format("%.6f", value)
    if text ~= last[name] and engine.cvar_get(name) ~= "" then
        last[name] = text
        engine.cvar_set(name, text)
    end
end

engine.on_frame("visor", function()
    set("r_ui_echo_scale", echo_scale)
    set("r_ui_echo", engine.hud_visible() and echo_in_game or echo_in_menu)
end)
