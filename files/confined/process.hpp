// SPDX-License-Identifier: MIT
#pragma once
// A program of ours that reads what strangers made, and is confined before it does (confined/inside/confine.hpp).
// Whatever becomes of it costs its caller an error. It is started by spawn, never by fork: the caller has threads.

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <darkroom/result.hpp>
#include <mutex>
#include <span>
#include <string>

#include "confined/descriptor.hpp"

namespace darkroom {

class ConfinedProcess {
  public:
    /// `program`: of program_module().
    explicit ConfinedProcess(std::string program) : program_(std::move(program)) {}
    ConfinedProcess(const ConfinedProcess&) = delete;
    ConfinedProcess& operator=(const ConfinedProcess&) = delete;
    ~ConfinedProcess() { static_cast<void>(stop()); }

    /// Nothing where it runs. Returns when it is confined and ready, or says as the machine's error why it is not.
    [[nodiscard]] Result<> start(std::span<const std::string> arguments = {});
    /// For all that start from now on: one whose kernel cannot hold its calls back goes on without, instead of ending.
    static void allow_unconfined(bool is_allowed);
    [[nodiscard]] static bool allows_unconfined();
    /// One that has ended since it was last asked, by whatever hand, is not.
    [[nodiscard]] bool is_running() const;
    /// Of all its memory, in address space; nothing under a sanitizer, whose shadow alone is terabytes.
    void limit_memory(std::uint64_t bytes) const;
    /// How long one send or receive may wait.
    void limit_wait(std::uint32_t seconds) const;
    [[nodiscard]] bool send(const void* data, std::size_t size, std::span<const int> descriptors = {}) const;
    [[nodiscard]] bool receive(void* data, std::size_t size) const;
    /// From any thread, at the end: what waits fails soon, and so does all that comes.
    void cancel();
    /// Ends it; to be called when a send or a receive has failed. Returns how it ended: "took more than 60 s", "was
    /// ended by signal 11 (Segmentation fault)".
    std::string stop();

  private:
    [[nodiscard]] Failure failed(const std::string& why) const;

    std::string program_;
    std::mutex mutex_;  // of the socket's number and of is_cancelled_
    bool is_cancelled_ = false;
    mutable bool is_late_ = false;
    mutable std::uint32_t max_seconds_ = 0;
    pid_t process_ = -1;
    Descriptor socket_;
};

}  // namespace darkroom
