// SPDX-License-Identifier: MIT
// No exception leaves the console or the controllers, nor goes through a script: it becomes an error, or is printed.

#include <filesystem>
#include <fstream>

#include "core/test_support_failing.hpp"
#include "script/test_controllers.hpp"

namespace darkroom {
namespace {

using test::with_each_allocation_failing;

// Of the host's allocations, that is: Lua's own are bounded and tried in hostile_test.cpp.
TEST(ScriptExceptions, EveryAllocationOfEveryFunctionMayFail) {
    if (!test::counts_allocations()) GTEST_SKIP() << "this build has its own operator new";
    const std::filesystem::path config = std::filesystem::temp_directory_path() / "darkroom_script_exceptions.cfg";
    test::ConsoleBed bed;
    const LogSink print = [](Severity, std::string_view) {};
    Console console(bed.composer, {.print = print});
    const std::string wrong_value = std::string(100, '1') + "x", long_owner(100, 'o');
    with_each_allocation_failing("execute", [&] { console.execute("gamma 1; reset gamma; cvarlist r_ui; nothing 1"); });
    with_each_allocation_failing("set", [&] { return console.set("gamma", "9").has_value(); });
    with_each_allocation_failing("set, refused", [&] { return console.set("gamma", wrong_value).has_value(); });
    with_each_allocation_failing("set_override",
                                 [&] { return console.set_override("gamma", long_owner, "1").has_value(); });
    with_each_allocation_failing("write_config", [&] { return console.write_config(config).has_value(); });
    with_each_allocation_failing("read_config", [&] { return console.read_config(config).has_value(); });
    std::filesystem::remove(config);

    with_each_allocation_failing("create", [&] { return Controllers::create(console, {.print = print}).has_value(); });
    auto controllers = Controllers::create(console, {.print = print});
    ASSERT_TRUE(controllers);
    const std::string script =
        "engine.on_frame('a slot with a name that is long', function()\n"
        "engine.cvar_set('gamma', engine.cvar_get_number('gamma') + 0.001) engine.cvar_set('nothing', 1)\n"
        "engine.cvar_set('contrast', 1.5) engine.exec('gamma') print('a line that is long enough') end)\n"
        "engine.on_frame('wrong', function() error('a text that is long enough') end)";
    for (std::uint64_t number = 0;; ++number) {
        std::string name = "a script with a name that is long";
        const test::FailingAllocation failing(number);
        EXPECT_NO_THROW(static_cast<void>(controllers->load_text(std::move(name), script))) << number;
        if (!failing.has_failed()) break;
    }
    double time = 0;
    with_each_allocation_failing("frame", [&] { controllers->frame({.time = time += 2}); });
    with_each_allocation_failing("restart", [&] { controllers->restart(); });
    // All of it goes on.
    const std::uint64_t writes = controllers->writes();
    controllers->frame({.time = time += 2});
    EXPECT_EQ(controllers->writes(), writes + 2);
}

}  // namespace
}  // namespace darkroom
