// SPDX-License-Identifier: MIT
// darkroom verify: does this device's driver make of every kernel what the references say? Here are its flags; the work
// is that of a program of its own.
#include <memory>

#include "programs/darkroom/commands.hpp"
#include "verify_flags.hpp"

namespace app {

void VerifyFlags::add_to(CommandFlags command) {
    command.add_option("--device", device, "Name (or a part of it) or index; see `darkroom devices`")
        .type_name("NAME|INDEX");
    command.add_option("--effect", effects, "This one alone, in each of its forms; may stand several times")
        .type_name("NAME")
        .repeated();
    seconds
        .add_to(command,
                "Begins nothing later than that, and says what was not tried; default: 60, or no end on a driver "
                "that runs on the processor")
        .type_name("S");
    seed.add_to(command, "Of the values at random; default: 1").type_name("N");
    command
        .add_option("-o,--output,--out", folder,
                    "A folder for verify.json and, of each finding, pictures and the smallest look that shows it")
        .type_name("DIR");
    command.add_option("--report", report, "Writes all of it into one file of JSON").type_name("FILE");
    command.add_flag("--json", is_json, "For programs");
}

Command add_verify(CommandFlags program, const Verify& verify) {
    const CommandFlags command =
        program.add_command("verify", "Runs every kernel on a device and compares it with the references");
    command.examples(
        "darkroom verify\n"
        "darkroom verify --device 0 --seconds 300 -o verified\n"
        "darkroom verify --effect bloom --effect ssao --report report.json");
    const auto flags = std::make_shared<VerifyFlags>();
    flags->add_to(command);
    return {command, [flags, verify] { return verify(*flags); }};
}

CommandRow verify_command() {
    return {.names = {"verify"}, .place = 240, .is_rare = true, .add = [](const CommandHost& host) {
                return std::vector{add_verify(
                    host.program, [become = host.become](const VerifyFlags&) { return become("darkroom_verifier"); })};
            }};
}

}  // namespace app
