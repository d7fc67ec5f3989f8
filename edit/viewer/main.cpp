// SPDX-License-Identifier: MIT
// darkroom_viewer: what `darkroom play` and `darkroom edit` start, with the same arguments.
#include <fmt/format.h>

#include "programs/darkroom/flags/program.hpp"
#include "programs/darkroom/run/report.hpp"
#include "viewer/input/keys.hpp"
#include "viewer/input/view_job.hpp"

namespace {

int view(const app::ViewFlags& flags) {
    if (flags.asks_for_keys) {
        fmt::print("{}", app::keys_text());
        return app::exit_ok;
    }
    darkroom::Result<app::ViewerJob> job = app::job_of(flags);
    return job ? app::run_viewer(std::move(*job)) : app::fail(job.error());
}

}  // namespace

int main(int argc, char** argv) {
    return app::run_program(argc, argv,
                            [](auto program, auto named, auto) { return app::add_view(program, named, view); });
}
