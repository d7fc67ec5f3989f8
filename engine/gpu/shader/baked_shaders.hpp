// SPDX-License-Identifier: MIT
#pragma once
// SPIR-V by the identity of its text, as a file (.dkb): a head, an index in ascending order, then the kernels, all
// little-endian. A file is hostile until it was read: every count, place and length is checked against its size, and a
// hash tells damage. It is kept as it is, and a kernel unpacked for who asks for it. What the words do is the driver's
// matter: who hands a file over trusts its maker.

#include <cstddef>
#include <cstdint>
#include <darkroom/device.hpp>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "core/digest/sha256.hpp"
#include "core/try.hpp"
#include "gpu/shader/shader_stage.hpp"

namespace darkroom::gpu {

/// "gpu" or "software"
[[nodiscard]] std::string_view profile_name(DeviceProfile profile);

using ShaderKey = std::pair<Digest, ShaderStage>;

/// What a file is made of.
struct ShadersToBake {
    DeviceProfile profile = DeviceProfile::Gpu;
    std::map<ShaderKey, std::vector<std::uint32_t>> words;

    [[nodiscard]] std::vector<std::byte> bytes() const;
};

class BakedShaders {
  public:
    static constexpr std::size_t max_bytes = std::size_t{16} << 20U;  ///< of a file
    static constexpr std::size_t max_shaders = 65536;

    BakedShaders() = default;
    /// Needs no memory but for a copy of the file. Errors: no such file, one of another version, one that is damaged or
    /// beyond the limits.
    [[nodiscard]] static Result<BakedShaders> read(std::span<const std::byte> file);
    /// None: it is not there.
    [[nodiscard]] std::optional<std::vector<std::uint32_t>> find(const Digest& text, ShaderStage stage) const;
    [[nodiscard]] std::size_t size() const { return count_; }
    /// Whose texts they are.
    [[nodiscard]] DeviceProfile profile() const { return profile_; }

  private:
    std::vector<std::byte> file_;
    std::size_t count_ = 0;
    DeviceProfile profile_ = DeviceProfile::Gpu;
};

}  // namespace darkroom::gpu
