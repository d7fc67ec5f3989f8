#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: a Lua 5.5 script makes longer text of the same numbers than 5.4, so names and files that hold them change.
# Versions: PyPI lupa 2.8 (Lua 5.4 and Lua 5.5)
# Behaviour: 5.4 prints 14 digits, which often is less than the number; 5.5 goes on to 17 where 15 do not read back as the
#   same. Text of a sum like 0.7 * 3 shows its rounding; a key or file name made of it is another one. And the variable
#   of a `for` is constant in 5.5: a script that assigns to it does not load.
# Seen: 0.7 * 3 is 2.1 and 2.0999999999999996, 2^53 is 9.007199254741e+15 and 9007199254740992.0
# Date: 2026-11-28
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check lupa==2.8 || exit 77
venv/bin/python - <<'END'
import sys

import lupa.lua54
import lupa.lua55

programs = ["tostring(0.7 * 3)", "tostring(2^53)", "tonumber(tostring(1/3)) == 1/3", "tostring(0.1)"]
loop = "local sum = 0 for i = 1, 3 do i = i + 1 sum = sum + i end return sum"
seen = []
for module in (lupa.lua54, lupa.lua55):
    lua = module.LuaRuntime()
    values = [lua.eval(program) for program in programs]
    try:
        values.append(lua.execute(loop))
    except module.LuaSyntaxError:
        values.append("refused")
    print("seen:", lua.lua_implementation, values)
    seen.append(values)
old = ["2.1", "9.007199254741e+15", False, "0.1", 9]
new = ["2.0999999999999996", "9007199254740992.0", True, "0.1", "refused"]
sys.exit(seen != [old, new])
END
