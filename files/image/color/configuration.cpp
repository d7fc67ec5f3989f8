// SPDX-License-Identifier: MIT
#include "image/color/configuration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/files.hpp"
#include "core/text/param_text.hpp"

namespace darkroom {
namespace {

constexpr std::uintmax_t max_configuration = std::uintmax_t{16} << 20;

template <class Make>
Result<std::shared_ptr<const ColorChain>> made_of(const std::filesystem::path& path, const Make& make) {
    const auto refuse = [&](const Error& error) {
        return failure(Error{error.fault, fmt::format("{}: {}", printable(path.string()), error.text)});
    };
    DARKROOM_TRY(check_configuration(path));
    const Result<const ColorChains*> chains = color_chains();
    if (!chains) return refuse(chains.error());
    Result<std::unique_ptr<ColorChain>> chain = make(**chains);
    if (!chain) return refuse(chain.error());
    return std::shared_ptr<const ColorChain>(std::move(*chain));
}

}  // namespace

Result<> check_configuration(const std::filesystem::path& configuration) {
    const auto text = read_file(configuration, {.max_size = max_configuration});
    return text ? Result<>() : failure(text.error());
}

Result<std::shared_ptr<const ColorChain>> space_of_configuration(const std::filesystem::path& configuration,
                                                                 const std::string& space) {
    return made_of(configuration, [&](const ColorChains& chains) { return chains.from_space(configuration, space); });
}

Result<std::shared_ptr<const ColorChain>> view_of_configuration(const std::filesystem::path& configuration,
                                                                const std::string& display, const std::string& view,
                                                                const std::string& space) {
    return made_of(configuration,
                   [&](const ColorChains& chains) { return chains.to_view(configuration, display, view, space); });
}

void apply(const ColorChain& chain, Picture& picture) {
    std::vector<std::array<float, 3>> row(picture.width);
    for (std::uint32_t y = 0; y < picture.height; ++y) {
        for (std::uint32_t x = 0; x < picture.width; ++x) std::copy_n(picture.at(x, y), 3, row[x].begin());
        chain.apply(row);
        for (std::uint32_t x = 0; x < picture.width; ++x)
            for (std::size_t c = 0; c < 3; ++c) picture.at(x, y)[c] = std::isfinite(row[x][c]) ? row[x][c] : 0.0f;
    }
}

}  // namespace darkroom
