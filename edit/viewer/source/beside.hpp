// SPDX-License-Identifier: MIT
#pragma once
// Work beside the frames, such as reading and writing files: on a thread of its own, or, where none can be started, at
// once, while the window waits.

#include <future>
#include <system_error>
#include <type_traits>

namespace app {

/// What `work` returns, as soon as it has. `has_thread` tells whether it runs beside the caller.
template <class Work>
[[nodiscard]] std::future<std::invoke_result_t<Work>> beside(const Work& work, bool& has_thread) {
    has_thread = true;
    try {
        return std::async(std::launch::async, work);
    } catch (const std::system_error&) {
        has_thread = false;
    }
    std::packaged_task<std::invoke_result_t<Work>()> here(work);
    std::future<std::invoke_result_t<Work>> out = here.get_future();
    here();
    return out;
}

}  // namespace app
