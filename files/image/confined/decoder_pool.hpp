// SPDX-License-Identifier: MIT
#pragma once
// The processes that decode pictures (darkroom_decode): confined, started when they are first needed, kept for the next
// pictures, and as many as there are pictures decoded at a time, up to the number of processors. Each decodes one at a
// time, so when one is lost it is known by which.

#include <condition_variable>
#include <cstdint>
#include <darkroom/result.hpp>
#include <memory>
#include <mutex>
#include <vector>

#include "confined/process.hpp"
#include "confined/shared_memory.hpp"

namespace darkroom {

/// One of them, and what it has open.
struct DecoderProcess {
    ConfinedProcess process{"darkroom_decode"};
    bool has_openimageio = false;
    bool is_busy = false;
    std::uint64_t source = 0;  ///< the picture that it has open, 0: none
    SharedMemory memory;       ///< for samples, which it has, too
    Mapping samples;           ///< the same, to be read
};

class DecoderPool {
  public:
    static DecoderPool& shared();

    /// A process that nobody else has until it is returned: that which has the picture open, if it is free; waits where
    /// there are as many as there may be. OpenImageIO takes longer to load than all else, and is not there unless
    /// asked.
    [[nodiscard]] Result<DecoderProcess*> take(std::uint64_t source, bool needs_openimageio);
    void give_back(DecoderProcess& process);

    /// How long a picture may take beyond what its size allows.
    std::uint32_t seconds = 60;
    /// Of a process without a picture, in address space: libraries, stacks and arenas of as many threads as it has.
    std::uint64_t memory_at_rest = std::uint64_t{4} << 30;
    /// And with one, for each byte that is decoded.
    std::uint64_t memory_of_a_byte = 4;

  private:
    std::mutex mutex_;
    std::condition_variable is_free_;
    std::vector<std::unique_ptr<DecoderProcess>> processes_;
};

/// For the process as a whole: false refuses every file of a picture before a decoder sees it. Whoever brings pixels
/// (LookOptions::load_resource, ResourceImage) needs none.
void allow_decoding(bool is_allowed);
[[nodiscard]] bool is_decoding_allowed();

}  // namespace darkroom
