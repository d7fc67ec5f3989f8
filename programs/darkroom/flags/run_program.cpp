// SPDX-License-Identifier: MIT
#include "run_program.hpp"

#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <string_view>

#include "core/files.hpp"
#include "program.hpp"
#include "programs/darkroom/effects/named_effects.hpp"
#include "programs/darkroom/help/help.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

namespace {

int run(int argc, char** argv, const AddCommands& add_commands) {
    const Program program;
    const std::span<char* const> arguments(argv, static_cast<std::size_t>(argc));
    add_help_flags(program.flags().parser());
    const std::vector<darkroom::LookEntry> named = effects_named_by(arguments);
    const std::vector<Command> commands = add_commands(program.flags(), named, argc > 1 ? argv[1] : "");
    for (const Command& command : commands) add_voice(command.flags);
    if (const std::optional<int> code = answer_help(program.flags().parser(), arguments)) return *code;
    const darkroom::Result<std::optional<int>> answered = program.parse(arguments);
    if (!answered) return fail(answered.error());
    if (*answered) return **answered;
    const auto chosen = std::ranges::find_if(commands, is_asked, &Command::flags);
    if (const darkroom::Result<> done = check_values(chosen->flags); !done) return fail(done.error());
    return chosen->run();
}

/// Started by a task of a farm, this process ends when that one does, by whatever hand.
void end_with_task() {
    const char* const task = std::getenv(task_of_farm);
    if (task == nullptr || std::to_string(::getppid()) != task) return;
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (std::to_string(::getppid()) != task) std::raise(SIGTERM);
}

}  // namespace

std::vector<Command> add_commands(const CommandRow& row, const CommandHost& host) {
    std::vector<Command> out = row.add(host);
    if (row.is_rare)
        for (const Command& command : out) command.flags.put_aside();
    return out;
}

int run_program(int argc, char** argv, const AddCommands& add_commands) {
    darkroom::AtomicPath::remove_on_signals();
    survive_size_limits();
    end_with_task();
    // Whoever reads objects reads of a wrong flag, too.
    for (int i = 1; i < argc; ++i) {
        const std::string_view word = argv[i];
        const bool is_json = word == "--progress" && i + 1 < argc && std::string_view(argv[i + 1]) == "json";
        if (is_json || word == "--progress=json") report_as_json();
    }
    // Exceptions come from third parties and from the allocator alone.
    try {
        return end_output(run(argc, argv, add_commands));
    } catch (const std::bad_alloc&) {
        complain("out of memory");
    } catch (const std::exception& error) {
        complain(error.what());
    }
    return exit_machine;
}

}  // namespace app
