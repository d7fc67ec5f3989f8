// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "scene/gltf/document.hpp"

namespace darkroom::scene::gltf {
namespace {

std::size_t size_of_component(int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
        default:
            return 0;
    }
}

std::uint32_t components_of(int type) {
    switch (type) {
        case TINYGLTF_TYPE_SCALAR:
            return 1;
        case TINYGLTF_TYPE_VEC2:
            return 2;
        case TINYGLTF_TYPE_VEC3:
            return 3;
        case TINYGLTF_TYPE_VEC4:
        case TINYGLTF_TYPE_MAT2:
            return 4;
        case TINYGLTF_TYPE_MAT3:
            return 9;
        case TINYGLTF_TYPE_MAT4:
            return 16;
        default:
            return 0;
    }
}

// Columns of matrices start at multiples of four bytes (glTF 2.0 specification, 3.6.2.4).
std::size_t padding_of_element(int type, std::size_t component) {
    if (type == TINYGLTF_TYPE_MAT2 && component == 1) return 4;
    if (type == TINYGLTF_TYPE_MAT3 && component < 4) return component == 1 ? 3 : 6;
    return 0;
}

std::size_t size_of_element(int type, std::size_t component) {
    return component * components_of(type) + padding_of_element(type, component);
}

// Bytes are little-endian, and so is every machine this is built for; they need not be aligned.
template <class T>
T read_as(const std::byte* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
}

std::uint32_t read_unsigned(const std::byte* bytes, int type) {
    if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return read_as<std::uint8_t>(bytes);
    if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) return read_as<std::uint16_t>(bytes);
    return read_as<std::uint32_t>(bytes);
}

// Normalised integers: glTF 2.0 specification, 3.6.2.2.
template <class T>
float to_float(const std::byte* bytes, bool is_normalized) {
    const auto value = static_cast<float>(read_as<T>(bytes));
    if constexpr (std::is_floating_point_v<T>) return value;
    if (!is_normalized) return value;
    return std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0F);
}

template <class T>
void convert_element(const std::byte* from, std::uint32_t components, bool is_normalized, float* to) {
    for (std::uint32_t c = 0; c < components; ++c) to[c] = to_float<T>(from + c * sizeof(T), is_normalized);
}

void convert(const std::byte* from, const Layout& layout, float* to) {
    switch (layout.component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return convert_element<std::int8_t>(from, layout.components, layout.is_normalized, to);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return convert_element<std::uint8_t>(from, layout.components, layout.is_normalized, to);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return convert_element<std::int16_t>(from, layout.components, layout.is_normalized, to);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return convert_element<std::uint16_t>(from, layout.components, layout.is_normalized, to);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return convert_element<std::uint32_t>(from, layout.components, layout.is_normalized, to);
        default:
            return convert_element<float>(from, layout.components, layout.is_normalized, to);
    }
}

}  // namespace

Result<Layout> Document::make_layout(int index) {
    const tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(index)];
    const std::string pointer = fmt::format("/accessors/{}", index);
    const auto wrong = [&](std::string_view what) { return user_error(fmt::format("{}: {}", pointer, what)); };
    const std::size_t component = size_of_component(accessor.componentType);
    const std::size_t element = size_of_element(accessor.type, component);
    Layout layout{.count = accessor.count,
                  .components = components_of(accessor.type),
                  .component_type = accessor.componentType,
                  .is_normalized = accessor.normalized,
                  .stride = element};
    if (component == 0 || element == 0) return wrong("a type that is not known");
    if (accessor.bufferView < 0) {
    } else {
        const auto bytes = view(accessor.bufferView);
        if (!bytes) return failure(Error(bytes.error()));
        const std::size_t stride = model_.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
        if (stride != 0 && stride < element)
            return wrong(fmt::format("elements of {} bytes, bufferView {} has a stride of {}", element,
                                     accessor.bufferView, stride));
        if (stride != 0) layout.stride = stride;
        const std::size_t offset = model_.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteOffset;
        if (accessor.byteOffset % component != 0 || (offset + accessor.byteOffset) % component != 0)
            faults_.warn(fmt::format("{}: is not aligned to {} bytes", pointer, component));
        // count is at most 2^40 and the stride at most 252, so nothing here overflows.
        const std::size_t end =
            accessor.byteOffset + layout.stride * (accessor.count - 1) + element -
            padding_of_element(accessor.type, component) / (accessor.type == TINYGLTF_TYPE_MAT2 ? 2 : 3);
        if (end > bytes->size())
            return wrong(fmt::format("ends {} bytes beyond bufferView {}", end - bytes->size(), accessor.bufferView));
        layout.data = bytes->subspan(accessor.byteOffset);
    }
    if (accessor.sparse.isSparse) DARKROOM_TRY(add_sparse(accessor, pointer, layout));
    return layout;
}

Result<> Document::add_sparse(const tinygltf::Accessor& accessor, const std::string& pointer, Layout& layout) {
    const auto& sparse = accessor.sparse;
    const auto wrong = [&](std::string_view place, std::string_view what) {
        return user_error(fmt::format("{}/sparse/{}: {}", pointer, place, what));
    };
    const auto take = [&](int index, std::size_t start, std::size_t needed,
                          const char* place) -> Result<std::span<const std::byte>> {
        const auto bytes = view(index);
        if (!bytes) return failure(Error(bytes.error()));
        if (start > bytes->size() || needed > bytes->size() - start)
            return wrong(place,
                         fmt::format("ends {} bytes beyond bufferView {}", start + needed - bytes->size(), index));
        return bytes->subspan(start, needed);
    };
    layout.sparse_count = static_cast<std::size_t>(sparse.count);
    layout.sparse_type = sparse.indices.componentType;
    if (layout.sparse_count > layout.count)
        return wrong("count", fmt::format("{}, the accessor has {}", layout.sparse_count, layout.count));
    const std::size_t index_size = size_of_component(layout.sparse_type);
    const bool is_unsigned = layout.sparse_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                             layout.sparse_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                             layout.sparse_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (!is_unsigned) return wrong("indices/componentType", fmt::format("{} is not allowed", layout.sparse_type));
    DARKROOM_TRY_VALUE(auto indices, take(sparse.indices.bufferView, sparse.indices.byteOffset,
                                          layout.sparse_count * index_size, "indices"));
    const std::size_t element = size_of_element(accessor.type, size_of_component(accessor.componentType));
    DARKROOM_TRY_VALUE(
        auto values, take(sparse.values.bufferView, sparse.values.byteOffset, layout.sparse_count * element, "values"));
    std::size_t next = 0;
    for (std::size_t i = 0; i < layout.sparse_count; ++i) {
        const std::uint32_t index = read_unsigned(indices.data() + i * index_size, layout.sparse_type);
        if (index < next || index >= layout.count)
            return wrong("indices",
                         fmt::format("number {} is {}, allowed is [{}, {}]", i, index, next, layout.count - 1));
        next = std::size_t{index} + 1;
    }
    layout.sparse_indices = indices;
    layout.sparse_values = values;
    return {};
}

Result<const Layout*> Document::layout(int accessor) {
    DARKROOM_TRY(faults_.check(fmt::format("/accessors/{}", accessor)));
    return &*layouts_[static_cast<std::size_t>(accessor)];
}

Result<Numbers> Document::numbers(int accessor) {
    DARKROOM_TRY_VALUE(auto found, layout(accessor));
    const Layout& layout = *found;
    const std::size_t size = layout.count * layout.components;
    DARKROOM_TRY(budget_.take(fmt::format("/accessors/{}", accessor), "numbers", size, sizeof(float)));
    Numbers out{.values = std::vector<float>(size), .components = layout.components, .count = layout.count};
    if (!layout.data.empty())
        for (std::size_t i = 0; i < layout.count; ++i)
            convert(layout.data.data() + i * layout.stride, layout, out.values.data() + i * layout.components);
    const std::size_t index_size = size_of_component(layout.sparse_type);
    const std::size_t element = layout.sparse_count == 0 ? 0 : layout.sparse_values.size() / layout.sparse_count;
    for (std::size_t i = 0; i < layout.sparse_count; ++i) {
        const std::size_t index = read_unsigned(layout.sparse_indices.data() + i * index_size, layout.sparse_type);
        convert(layout.sparse_values.data() + i * element, layout, out.values.data() + index * layout.components);
    }
    return out;
}

// What the file says of its extents is not used, but tells of damage.
void Document::check_extent(int index) {
    const tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(index)];
    const Layout& layout = *layouts_[static_cast<std::size_t>(index)];
    const bool is_padded = padding_of_element(accessor.type, size_of_component(accessor.componentType)) != 0;
    if ((layout.data.empty() && layout.sparse_count == 0) || is_padded) return;
    const std::uint64_t taken = budget_.taken();
    const auto numbers = this->numbers(index);
    budget_.give_back_to(taken);
    if (!numbers) return;
    const std::size_t components = layout.components;
    std::vector<float> low(components, std::numeric_limits<float>::infinity());
    std::vector<float> high(components, -std::numeric_limits<float>::infinity());
    bool is_finite = true;
    for (std::size_t i = 0; i < numbers->values.size(); ++i) {
        const float value = numbers->values[i];
        is_finite = is_finite && std::isfinite(value);
        low[i % components] = std::min(low[i % components], value);
        high[i % components] = std::max(high[i % components], value);
    }
    if (!is_finite) return faults_.warn(fmt::format("/accessors/{}: has a value that is not finite", index));
    // The extents of normalised integers are those of the integers.
    if (layout.is_normalized) return;
    const auto differ = [&](const std::vector<double>& said, const std::vector<float>& is) {
        if (said.size() != components) return false;
        for (std::size_t c = 0; c < components; ++c) {
            const double tolerance = 1e-5 * std::max(1.0, std::abs(static_cast<double>(is[c])));
            if (std::abs(said[c] - static_cast<double>(is[c])) > tolerance) return true;
        }
        return false;
    };
    if (differ(accessor.minValues, low) || differ(accessor.maxValues, high))
        faults_.warn(fmt::format("/accessors/{}: min and max are not those of the data", index));
}

Result<std::vector<std::uint32_t>> Document::integers(int accessor) {
    DARKROOM_TRY_VALUE(auto found, layout(accessor));
    const Layout& layout = *found;
    const bool is_unsigned = layout.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                             layout.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                             layout.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (!is_unsigned || layout.is_normalized)
        return user_error(fmt::format("/accessors/{}: unsigned integers are needed here", accessor));
    const std::size_t size = layout.count * layout.components;
    DARKROOM_TRY(budget_.take(fmt::format("/accessors/{}", accessor), "numbers", size, sizeof(std::uint32_t)));
    std::vector<std::uint32_t> out(size);
    const std::size_t component = size_of_component(layout.component_type);
    const auto take = [&](const std::byte* from, std::size_t element) {
        for (std::size_t c = 0; c < layout.components; ++c)
            out[element * layout.components + c] = read_unsigned(from + c * component, layout.component_type);
    };
    if (!layout.data.empty())
        for (std::size_t i = 0; i < layout.count; ++i) take(layout.data.data() + i * layout.stride, i);
    const std::size_t index_size = size_of_component(layout.sparse_type);
    for (std::size_t i = 0; i < layout.sparse_count; ++i)
        take(layout.sparse_values.data() + i * component * layout.components,
             read_unsigned(layout.sparse_indices.data() + i * index_size, layout.sparse_type));
    return out;
}

}  // namespace darkroom::scene::gltf
