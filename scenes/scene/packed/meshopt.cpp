// SPDX-License-Identifier: MIT
#include "scene/packed/meshopt.hpp"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <utility>

namespace darkroom::scene {
namespace {

constexpr auto modes = std::to_array<std::pair<std::string_view, MeshoptMode>>({{"ATTRIBUTES", MeshoptMode::Attributes},
                                                                                {"TRIANGLES", MeshoptMode::Triangles},
                                                                                {"INDICES", MeshoptMode::Indices}});
constexpr auto filters =
    std::to_array<std::pair<std::string_view, MeshoptFilter>>({{"NONE", MeshoptFilter::None},
                                                               {"OCTAHEDRAL", MeshoptFilter::Octahedral},
                                                               {"QUATERNION", MeshoptFilter::Quaternion},
                                                               {"EXPONENTIAL", MeshoptFilter::Exponential}});

constexpr std::uint64_t max_stride = 256;

template <class T, std::size_t size>
Result<T> named(const std::array<std::pair<std::string_view, T>, size>& known, const std::string& name,
                std::string_view property) {
    std::string allowed;
    for (const auto& [known_name, value] : known) {
        if (known_name == name) return value;
        allowed += fmt::format("{}{}", allowed.empty() ? "" : ", ", known_name);
    }
    return user_error(fmt::format("{}: \"{}\", allowed is {}", property, name.substr(0, 40), allowed));
}

void filter(std::vector<std::byte>& values, const MeshoptDesc& desc) {
    switch (desc.filter) {
        case MeshoptFilter::None:
            return;
        case MeshoptFilter::Octahedral:
            return meshopt_decodeFilterOct(values.data(), desc.count, desc.stride);
        case MeshoptFilter::Quaternion:
            return meshopt_decodeFilterQuat(values.data(), desc.count, desc.stride);
        case MeshoptFilter::Exponential:
            return meshopt_decodeFilterExp(values.data(), desc.count, desc.stride);
    }
}

}  // namespace

Result<MeshoptMode> meshopt_mode(const std::string& name) { return named(modes, name, "mode"); }
Result<MeshoptFilter> meshopt_filter(const std::string& name) { return named(filters, name, "filter"); }

Result<> check_meshopt(const MeshoptDesc& desc) {
    const auto wrong_stride = [&](std::string_view allowed) {
        return user_error(fmt::format("byteStride: {}, allowed is {}", desc.stride, allowed));
    };
    const bool is_indices = desc.mode != MeshoptMode::Attributes;
    if (is_indices && desc.stride != 2 && desc.stride != 4) return wrong_stride("2 or 4 for indices");
    if (!is_indices && (desc.stride == 0 || desc.stride % 4 != 0 || desc.stride > max_stride))
        return wrong_stride("a multiple of 4 up to 256");
    if (desc.mode == MeshoptMode::Triangles && desc.count % 3 != 0)
        return user_error(fmt::format("count: {}, a multiple of 3 is needed for TRIANGLES", desc.count));
    if (is_indices && desc.filter != MeshoptFilter::None) return user_error("filter: only ATTRIBUTES have one");
    if (desc.filter == MeshoptFilter::Octahedral && desc.stride != 4 && desc.stride != 8)
        return wrong_stride("4 or 8 for OCTAHEDRAL");
    if (desc.filter == MeshoptFilter::Quaternion && desc.stride != 8) return wrong_stride("8 for QUATERNION");
    return {};
}

Result<std::vector<std::byte>> unpack_meshopt(std::span<const std::byte> bytes, const MeshoptDesc& desc) {
    std::vector<std::byte> values(desc.count * desc.stride);
    const auto* const packed = reinterpret_cast<const unsigned char*>(bytes.data());
    int error = 0;
    switch (desc.mode) {
        case MeshoptMode::Attributes:
            error = meshopt_decodeVertexBuffer(values.data(), desc.count, desc.stride, packed, bytes.size());
            break;
        case MeshoptMode::Triangles:
            error = meshopt_decodeIndexBuffer(values.data(), desc.count, desc.stride, packed, bytes.size());
            break;
        case MeshoptMode::Indices:
            error = meshopt_decodeIndexSequence(values.data(), desc.count, desc.stride, packed, bytes.size());
            break;
    }
    if (error != 0)
        return user_error(
            fmt::format("{} packed bytes that are not {} elements of {} bytes", bytes.size(), desc.count, desc.stride));
    filter(values, desc);
    return values;
}

}  // namespace darkroom::scene
