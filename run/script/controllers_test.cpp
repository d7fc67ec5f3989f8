// SPDX-License-Identifier: MIT
// What scripts can do, and what becomes of them. Scripts that mean harm are in hostile_test.cpp.
#include <unistd.h>

#include <fstream>

#include "script/test_controllers.hpp"

namespace darkroom {
namespace {

namespace fs = std::filesystem;
using test::ControllersBed;

TEST(Controllers, ReadAndSetVariables) {
    ControllersBed bed;
    EXPECT_EQ(bed.value("engine.cvar_get('r_ui_warp'), type(engine.cvar_get('r_ui_warp'))"), "-0.15 string");
    EXPECT_EQ(bed.value("engine.cvar_get_number('r_ui_warp') * 2"), "-0.3");
    EXPECT_EQ(bed.value("engine.cvar_get('nothing') == '', engine.cvar_get_number('nothing')"), "true 0.0");
    EXPECT_EQ(bed.value("engine.cvar_get('sample.shape'), engine.cvar_get_number('sample.shape')"), "round 0.0");
    EXPECT_EQ(bed.load("engine.cvar_set('r_ui_warp', '0.25') engine.cvar_set('gamma', 0.5)\n"
                       "engine.cvar_set('sample.is_on', true) engine.cvar_set('sample.shape', 'star')"),
              "");
    EXPECT_EQ(bed.console->get("warp.strength"), "0.25");
    EXPECT_EQ(bed.console->get("gamma"), "0.5");
    EXPECT_EQ(bed.console->get("sample.is_on"), "1");
    EXPECT_EQ(bed.console->get("sample.shape"), "star");
    EXPECT_EQ(bed.value("engine.cvar_set('nothing', 1)"), "");
    bed.said.clear();
    bed.load("engine.cvar_set('nothing', '1') engine.cvar_set('gamma', '99')");
    EXPECT_EQ(bed.said,
              (std::vector<std::string>{"variable nothing not found", "gamma = 99: allowed is [0.25, 4], set to 4"}));
    EXPECT_EQ(bed.load("engine.exec('contrast 2; toggle sample.is_on')"), "");
    EXPECT_EQ(bed.console->get("contrast"), "2");
    EXPECT_EQ(bed.console->get("sample.is_on"), "0");
}

TEST(Controllers, ACallbackSetsItsSlotsOverrideAndTheBaseStays) {
    ControllersBed bed;
    ASSERT_EQ(bed.load("engine.on_frame('bend', function() engine.cvar_set('r_ui_warp', engine.time())\n"
                       "  seen = engine.cvar_get('r_ui_warp') print(seen) end)"),
              "");
    EXPECT_EQ(bed.now("warp"), -0.15f) << "not before a frame";
    bed.frame(0.5);
    EXPECT_EQ(bed.now("warp"), 0.5f);
    EXPECT_EQ(bed.console->get("r_ui_warp"), "-0.15");
    bed.frame(0.75);
    EXPECT_EQ(bed.said.back(), "-0.15") << "no script reads what a script made";
    bed.run("r_ui_warp 0.125");
    bed.frame(1);
    EXPECT_EQ(bed.said.back(), "0.125");
    EXPECT_EQ(bed.controllers->writes(), 3u);
    bed.controllers->unload("test");
    EXPECT_EQ(bed.now("warp"), 0.125f) << "nothing of it is left";
    EXPECT_TRUE(bed.controllers->slots().empty());
    bed.frame(2);
    EXPECT_EQ(bed.controllers->writes(), 3u);
}

TEST(Controllers, StateTheirPreRoll) {
    ControllersBed bed;
    EXPECT_EQ(bed.controllers->pre_roll(), 0.0) << "without scripts nothing remembers";
    const std::string callback = "engine.on_frame('a', function() end)";
    EXPECT_EQ(bed.load(callback + " engine.pre_roll(0.5)", "half"), "");
    EXPECT_EQ(bed.load(callback + " engine.pre_roll(2)", "two"), "");
    EXPECT_EQ(bed.controllers->pre_roll(), 2.0) << "the largest";
    EXPECT_NE(bed.load("engine.pre_roll(3) error('no')", "half"), "");
    EXPECT_EQ(bed.controllers->pre_roll(), 2.0) << "the script before stays";
    EXPECT_EQ(bed.load(callback, "silent"), "");
    EXPECT_EQ(bed.controllers->pre_roll(), std::nullopt) << "one that does not say may remember all";
    bed.controllers->unload("silent");
    EXPECT_EQ(bed.controllers->pre_roll(), 2.0);
    for (const char* const wrong : {"-1", "86401", "0/0", "'a'"})
        EXPECT_NE(bed.load(std::string("engine.pre_roll(") + wrong + ")", "wrong"), "") << wrong;
    EXPECT_EQ(bed.load("engine.on_frame('late', function() engine.pre_roll(1) end)", "late"), "");
    bed.frame(0);
    EXPECT_NE(bed.said.back().find("while it is loaded"), std::string::npos) << bed.said.back();
}

TEST(Controllers, TheLastRegistrationOfASlotWins) {
    ControllersBed bed;
    bed.load("engine.on_frame('a', function() print('old') engine.cvar_set('gamma', 2) end)", "one");
    bed.load("engine.on_frame('b', function() print('b') end)", "two");
    bed.frame();
    EXPECT_EQ(bed.now("tone", 1), 2.0f);
    bed.load("engine.on_frame('a', function() print('lost') end) engine.on_frame('a', function() print('new') end)",
             "three");
    EXPECT_EQ(bed.now("tone", 1), 0.9f) << "its override went with it";
    bed.said.clear();
    bed.frame(2);
    EXPECT_EQ(bed.said, (std::vector<std::string>{"new", "b"})) << "in the place of the first";
    EXPECT_EQ(bed.controllers->slots(), (std::vector<std::string>{"a", "b"}));
    bed.controllers->unload("one");
    EXPECT_EQ(bed.controllers->slots().size(), 2u) << "the slot is another script's now";
    bed.controllers->unload("three");
    EXPECT_EQ(bed.controllers->slots(), (std::vector<std::string>{"b"}));
}

TEST(Controllers, SlotsMayBeRegisteredByCallbacks) {
    ControllersBed bed;
    bed.load(
        "engine.on_frame('first', function()\n"
        "  engine.on_frame('second', function() print('second') end)\n"
        "  engine.on_frame('first', function() print('first anew') end)\n"
        "  print('first') end)");
    bed.frame(0);
    EXPECT_EQ(bed.said, (std::vector<std::string>{"first"}));
    bed.frame(1);
    EXPECT_EQ(bed.said, (std::vector<std::string>{"first", "first anew", "second"}));
    bed.controllers->unload("test");
    EXPECT_TRUE(bed.controllers->slots().empty()) << "they are of the script whose callback registered them";
}

TEST(Controllers, GameIsReadOnly) {
    ControllersBed bed;
    bed.game = {{"health", 75.0}, {"has_quad", true}, {"map", std::string("dm4")}};
    bed.load(
        "engine.on_frame('a', function()\n"
        "  print(game.health, game.has_quad, game.map, game.nothing, game[1])\n"
        "  local names = {} for name, value in pairs(game) do names[#names + 1] = name .. '=' .. tostring(value) end\n"
        "  print(table.concat(names, ' '))\n"
        "  print(pcall(function() game.health = 100 end))\n"
        "  print(pcall(rawset, game, 'health', 100))\n"
        "  print(getmetatable, setmetatable, game.health) end)");
    bed.frame();
    ASSERT_EQ(bed.said.size(), 5u);
    EXPECT_EQ(bed.said[0], "75.0 true dm4 nil nil");
    EXPECT_EQ(bed.said[1], "has_quad=true health=75.0 map=dm4");
    EXPECT_EQ(bed.said[2], "false test:5: attempt to write to read-only 'game' table");
    EXPECT_TRUE(bed.said[3].starts_with("false bad argument #1")) << bed.said[3];
    EXPECT_EQ(bed.said[4], "nil nil 75.0");
    EXPECT_EQ(bed.value("game.health"), "nil") << "the host's table is read in its frame alone";
    bed.said.clear();
    bed.controllers->frame({});
    EXPECT_EQ(bed.said[0], "nil nil nil nil nil") << "no table is an empty one";
}

TEST(Controllers, ErrorsAreToldWithATracebackOnceASecondAndTheSlotStays) {
    ControllersBed bed;
    bed.load(
        "local function inner() error('broken') end\n"
        "engine.on_frame('bad', function() count = (count or 0) + 1 inner() end)\n"
        "engine.on_frame('good', function() engine.cvar_set('gamma', 1 + engine.time() / 100) end)",
        "some.lua");
    for (int i = 0; i < 90; ++i) bed.frame(i / 60.0);
    ASSERT_EQ(bed.said.size(), 2u) << "in a second and a half";
    EXPECT_TRUE(bed.said[0].starts_with("slot 'bad': some.lua:1: broken\nstack traceback:\n")) << bed.said[0];
    EXPECT_NE(bed.said[0].find("some.lua:2: in function"), std::string::npos) << bed.said[0];
    EXPECT_TRUE(bed.said[1].ends_with("(59 more since the last)")) << bed.said[1];
    EXPECT_FLOAT_EQ(bed.now("tone", 1), static_cast<float>(1 + 89 / 6000.0)) << "the others go on";
    EXPECT_EQ(bed.controllers->slots().size(), 2u);
    bed.said.clear();
    bed.load("engine.on_frame('bad', function() error({}) end)", "some.lua");
    bed.frame(5);
    EXPECT_NE(bed.said[0].find("the error is a table"), std::string::npos) << bed.said[0];
}

TEST(Controllers, ScriptsThatFailToLoadLeaveTheOldOnes) {
    ControllersBed bed;
    ASSERT_EQ(bed.load("engine.on_frame('a', function() print('old') end)"), "");
    EXPECT_EQ(bed.load("engine.on_frame('a', function() print('new') end"), "test:1: ')' expected near <eof>");
    EXPECT_EQ(bed.load("engine.on_frame('a', function() print('new') end) error('no')"), "test:1: no");
    bed.frame();
    EXPECT_EQ(bed.said, (std::vector<std::string>{"old"}));
    EXPECT_EQ(bed.load("\x1bLua binary"), "test: attempt to load a binary chunk (mode is 't')") << "text alone";
    EXPECT_EQ(bed.load("engine.on_frame('b', function() end)"), "");
    EXPECT_EQ(bed.controllers->slots(), (std::vector<std::string>{"b"})) << "what it registers no more is gone";
    const auto missing = bed.controllers->load("/nowhere/at/all.lua");
    ASSERT_FALSE(missing);
    EXPECT_NE(missing.error().text.find("/nowhere/at/all.lua"), std::string::npos);
    EXPECT_NE(bed.load(std::string(300000, ' ')).find("262144"), std::string::npos);
}

TEST(Controllers, HotReloadCapturesDeclaredValues) {
    const fs::path file = fs::temp_directory_path() / ("darkroom_reload_" + std::to_string(::getpid()) + ".lua");
    const auto write = [&](const std::string& text) { std::ofstream(file) << text; };
    const std::string add =
        "local base = engine.cvar_get_number('r_ui_warp')\n"
        "engine.on_frame('add', function() engine.cvar_set('r_ui_warp', base + ";
    ControllersBed bed;
    write(add + "0.5) end)");
    ASSERT_TRUE(bed.controllers->load(file));
    bed.frame();
    EXPECT_FLOAT_EQ(bed.now("warp"), 0.35f);
    bed.controllers->reload_changed();
    EXPECT_FLOAT_EQ(bed.now("warp"), 0.35f) << "nothing changed";
    for (int i = 0; i < 3; ++i) {
        write(add + std::string(static_cast<std::size_t>(i), ' ') + "0.25) end)");
        bed.controllers->reload_changed();
        EXPECT_EQ(bed.now("warp"), -0.15f) << "until its next frame";
        bed.frame();
        EXPECT_FLOAT_EQ(bed.now("warp"), 0.1f) << "from -0.15, not from a disturbed frame";
    }
    write("this is no Lua");
    for (int i = 0; i < 3; ++i) bed.controllers->reload_changed();
    ASSERT_EQ(bed.said.size(), 1u) << "said once";
    EXPECT_NE(bed.said[0].find(".lua:1: syntax error"), std::string::npos) << bed.said[0];
    bed.frame();
    EXPECT_FLOAT_EQ(bed.now("warp"), 0.1f) << "the last good one runs";

    // Another look took its place: the overrides are gone, and the script does not know.
    bed.composer.drop_overrides("slot add");
    write(add + "0.75) end)");
    bed.controllers->restart();
    bed.frame();
    EXPECT_FLOAT_EQ(bed.now("warp"), 0.6f);
    fs::remove(file);
    bed.controllers->reload_changed();
    bed.frame();
    EXPECT_FLOAT_EQ(bed.now("warp"), 0.6f) << "a file that is gone";
}

TEST(Controllers, AScriptMayBeUnloadedWhileItRuns) {
    ControllersBed bed;
    bed.on_print = [&](std::string_view text) {
        if (text != "now") return;
        bed.controllers->unload("one");
        EXPECT_NE(bed.load("print('too early')", "three"), "") << "nothing is loaded meanwhile";
        bed.controllers->frame({});
        bed.controllers->restart();
        bed.controllers->reload_changed();
    };
    bed.load(
        "engine.on_frame('a', function() engine.cvar_set('gamma', 2) print('now') engine.cvar_set('gamma', 3)\n"
        "engine.on_frame('late', function() print('late') end) end)\n"
        "engine.on_frame('b', function() print('of the same script') end)",
        "one");
    bed.load("engine.on_frame('c', function() print('of another') end)", "two");
    bed.frame(0);
    ASSERT_EQ(bed.said.size(), 3u);
    EXPECT_NE(bed.said[1].find("the script was unloaded"), std::string::npos) << "it registers no more";
    EXPECT_EQ(bed.said[2], "of another");
    EXPECT_EQ(bed.now("tone", 1), 0.9f) << "what it set afterwards is gone, too";
    bed.said.clear();
    bed.frame(2);
    EXPECT_EQ(bed.said, (std::vector<std::string>{"of another"}));
    EXPECT_EQ(bed.load("print('now')", "one"), "") << "while it is being loaded";
}

TEST(Controllers, ScriptsShareNothingAndAreTheSameInEveryRun) {
    ControllersBed bed, again;
    EXPECT_EQ(bed.load("shared = 1 math.sin = nil string.rep = nil engine.time = nil _G.engine = nil", "one"), "");
    EXPECT_EQ(bed.value("shared, math.sin(0), ('ab'):rep(2), engine.time()"), "nil 0.0 abab 0.0");
    EXPECT_EQ(bed.load("x = 1 assert(_G.x == 1 and _ENV == _G)"), "");
    EXPECT_EQ(bed.value("math.random(1, 1000000)"), again.value("math.random(1, 1000000)"));
}

TEST(Controllers, WhatLuaOffersWorksWithinItsBounds) {
    ControllersBed bed;
    EXPECT_EQ(bed.value("string.format('%.6f %5d %s %x', 0.1234567, 42, 'a', 255)"), "0.123457    42 a ff");
    EXPECT_EQ(bed.value("('x'):rep(3, '-'), ('abc'):upper(), ('abc'):sub(2), ('abc'):byte(1), ('abc'):reverse()"),
              "x-x-x ABC bc 97 cba");
    EXPECT_EQ(bed.value("table.concat({1, 2, 3}, ','), select('#', table.unpack({1, 2, 3})), #table.pack(1, 2)"),
              "1,2,3 3 2");
    EXPECT_EQ(bed.value("(function() local t = {3, 1, 2} table.sort(t) table.insert(t, 4) table.remove(t, 1)\n"
                        "table.move(t, 1, 2, 3) return table.concat(t, ' ') end)()"),
              "2 3 2 3");
    EXPECT_EQ(bed.value("engine.cvar_get('r_ui_echo') + 1, '10' * 2"), "1.1 20");
    EXPECT_EQ(bed.value("pcall(error, 'x'), tostring(nil), tonumber('0x10'), type(print), 7 // 2, 1 << 4"),
              "false nil 16 function 3 16");
    for (const char* const absent :
         {"io",           "os",           "package",     "debug",       "coroutine",    "utf8",
          "require",      "load",         "loadstring",  "loadfile",    "dofile",       "collectgarbage",
          "setmetatable", "getmetatable", "xpcall",      "string.find", "string.match", "string.gmatch",
          "string.gsub",  "string.dump",  "string.pack", "('').find",   "('').gsub",    "math.randomseed",
          "_VERSION"})
        EXPECT_EQ(ControllersBed().value(absent), "nil") << absent;
}

TEST(Controllers, FilesAreReadOnlyWhereTheHostAllowsIt) {
    ControllersBed strict;
    strict.load("engine.exec('exec autoexec.cfg')");
    EXPECT_EQ(strict.said.back(), "exec autoexec.cfg: files are not read from here");
}

// Where the program lies in memory is nothing that scripts learn.
TEST(Controllers, NoTextTellsAnAddress) {
    ControllersBed bed;
    EXPECT_EQ(bed.value("tostring(print)"), "function");
    EXPECT_EQ(bed.value("tostring({})"), "table");
    EXPECT_EQ(bed.value("tostring(game)"), "userdata");
    EXPECT_EQ(bed.value("print"), "function");
    EXPECT_EQ(bed.value("string.format('%s %5s', print, {})"), "function table");
    EXPECT_EQ(bed.value("('%d%%'):format(7)"), "7%");
    for (const std::string format : {"%p", "%-20p", "% 5p", "%%%p", "\\0%p", "%s%p"})
        EXPECT_NE(bed.value("string.format('" + format + "', print, print)").find("is not allowed"), std::string::npos)
            << format;
    EXPECT_EQ(bed.value("tostring(nil) .. tostring(true) .. tostring(1.5) .. tostring('x')"), "niltrue1.5x");
}

TEST(Controllers, SetClassesOfTheDocument) {
    std::vector<std::string> set;
    ControllersBed bed(
        {.milliseconds_per_frame = 1e4, .set_class = [&](std::string_view id, std::string_view name, bool is_on) {
             set.push_back(std::string(id) + "." + std::string(name) + (is_on ? " on" : " off"));
             return id != "none";
         }});
    EXPECT_EQ(bed.value("engine.set_class('bar', 'low', true), engine.set_class('none', 'low', false)"), "true false");
    EXPECT_EQ(set, (std::vector<std::string>{"bar.low on", "none.low off"}));
    EXPECT_NE(bed.value("engine.set_class('bar', 'low')").find("boolean expected"), std::string::npos);
    EXPECT_NE(bed.value("engine.set_class(('x'):rep(300), 'low', true)").find("too long"), std::string::npos);
    EXPECT_EQ(ControllersBed().value("engine.set_class('bar', 'low', true)"), "false") << "there is no document";
}

}  // namespace
}  // namespace darkroom
