// SPDX-License-Identifier: MIT
// darkroom_verifier: what `darkroom verify` starts, with the same arguments.
#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <span>

#include "core/own_file.hpp"
#include "core/text/param_text.hpp"
#include "programs/darkroom/flags/device_flags.hpp"
#include "programs/darkroom/flags/program.hpp"
#include "programs/darkroom/run/outputs.hpp"
#include "programs/darkroom/run/report.hpp"
#include "programs/darkroom/verify/verify_flags.hpp"
#include "verifier/verify_report.hpp"

namespace app {

namespace {

namespace fs = std::filesystem;
using darkroom::printable;
using darkroom::Result;
using darkroom::user_error;
using darkroom::verify::Finding;

/// Of a device that is no processor; there, all are tried.
constexpr double usual_seconds = 60;

Result<> check_effects(const std::vector<std::string>& names) {
    std::vector<std::string> known;
    for (const darkroom::EffectInfo* const info : darkroom::all_effects()) known.emplace_back(info->name);
    for (const std::string& name : names)
        if (darkroom::find_effect(name) == nullptr)
            return user_error(fmt::format("--effect {}: there is no such effect{}", printable(name),
                                          darkroom::alternatives(name, known)));
    return {};
}

/// Told before the work, which takes minutes.
Result<> check_outputs(const VerifyFlags& flags) {
    const fs::path folder = flags.folder, report = flags.report;
    const fs::path own = folder / report_name;
    if (!folder.empty()) {
        DARKROOM_TRY(check_folder(folder, MissingFolders::Made));
        DARKROOM_TRY(check_report(own, FileSet({})));
    }
    if (report.empty()) return {};
    std::error_code error;
    if (!folder.empty() && fs::weakly_canonical(report, error) == fs::weakly_canonical(own, error))
        return user_error(fmt::format("--report {}: would be written by -o {}, too", printable(report.string()),
                                      printable(folder.string())));
    return check_report(report, FileSet({}));
}

Result<> write(const VerifyFlags& flags, const darkroom::verify::Report& report) {
    if (!flags.folder.empty()) DARKROOM_TRY(write_findings(flags.folder, report));
    if (flags.report.empty()) return {};
    const std::string text = json_of(report).dump(2) + "\n";
    return darkroom::write_own_file(flags.report, std::as_bytes(std::span(text)), darkroom::FileOwner::Anyone);
}

int verify(const VerifyFlags& flags) {
    const Result<std::optional<double>> seconds = flags.seconds.value();
    if (!seconds) return fail(seconds.error());
    if (const Result<> done = check_effects(flags.effects); !done) return fail(done.error());
    darkroom::verify::Options wanted{.subjects = {.effects = flags.effects}};
    if (const Result<> done = flags.seed.read_to(wanted.subjects.seed); !done) return fail(done.error());
    if (const Result<> done = check_outputs(flags); !done) return fail(done.error());
    Result<darkroom::Device> device = darkroom::Device::create({.select = flags.device, .log = log_sink()});
    if (!device) return fail(device.error());
    wanted.seconds = seconds->value_or(device->info().is_software ? 0 : usual_seconds);
    const darkroom::verify::Listener listener{
        .begins = [](const std::string& subject, std::size_t done,
                     std::size_t total) { remark(fmt::format("{} of {}: {}", done + 1, total, subject)); },
        .found =
            [&](const Finding& finding) {
                if (!flags.is_json) answer(text_of(finding));
            }};
    const Result<darkroom::verify::Report> report = darkroom::verify::run(*device, wanted, listener);
    if (!report) return fail(report.error());
    if (const Result<> done = write(flags, *report); !done) return fail(done.error());
    answer(flags.is_json ? json_of(*report).dump(2) : summary_of(*report));
    return finish(*device, report->findings.empty() ? exit_ok : exit_user);
}

}  // namespace

}  // namespace app

int main(int argc, char** argv) {
    return app::run_program(argc, argv, [](auto program, auto, auto) {
        return std::vector<app::Command>{app::add_verify(program, app::verify)};
    });
}
