// SPDX-License-Identifier: MIT
#pragma once
// What a table says of a property of glTF (tables.hpp): its name, its kind, and what is allowed.

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

namespace darkroom::scene::gltf {

/// Integers out of range make an element faulty, loose ones are passed over. UnusedIndex: checked, but nothing here
/// depends on it.
enum class Kind {
    Boolean,
    Integer,
    LooseInteger,
    Number,
    Numbers,
    Text,
    Index,
    UnusedIndex,
    Indices,
    IndexMap,
    IndexMaps,
    IntegerMap,
    Object,
    Objects
};

struct Definition;

/// A number outside low..high is reported and used.
struct Property {
    std::string_view name;
    Kind kind = Kind::Text;
    bool is_required = false;
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    std::size_t count = 0;      ///< of numbers; 0: any
    std::string_view target{};  ///< the array that an index points into
    const Definition* object = nullptr;
};

struct Definition {
    std::span<const Property> properties;
};

/// What most elements take in memory, with all that is in none of their arrays: the library's, and ours.
inline constexpr std::uint64_t element_size = 1024;

/// An array of the root. The placeholder stands for elements that cannot be used.
struct Array {
    std::string_view name;
    const Definition* definition = nullptr;
    std::string_view placeholder;
    std::uint64_t element_size = gltf::element_size;
};

/// The largest whole number: byte counts are larger than an int, but nothing is larger than this.
inline constexpr std::uint64_t max_integer = std::uint64_t{1} << 40;

// Where the library reads an int, a larger number would overflow.
inline constexpr double max_int = std::numeric_limits<std::int32_t>::max();

inline constexpr Property index_of(std::string_view name, std::string_view target, bool is_required = false) {
    return {.name = name, .kind = Kind::Index, .is_required = is_required, .target = target};
}
inline constexpr Property object_of(std::string_view name, const Definition& object, bool is_required = false) {
    return {.name = name, .kind = Kind::Object, .is_required = is_required, .object = &object};
}
inline constexpr Property integer(std::string_view name, double low = 0, double high = max_int,
                                  bool is_required = false) {
    return {.name = name, .kind = Kind::Integer, .is_required = is_required, .low = low, .high = high};
}
inline constexpr Property loose_integer(std::string_view name, double low, double high) {
    return {.name = name, .kind = Kind::LooseInteger, .low = low, .high = high};
}
inline constexpr Property number(std::string_view name, double low = -std::numeric_limits<double>::infinity(),
                                 double high = std::numeric_limits<double>::infinity(), bool is_required = false) {
    return {.name = name, .kind = Kind::Number, .is_required = is_required, .low = low, .high = high};
}
inline constexpr Property numbers(std::string_view name, std::size_t count,
                                  double low = -std::numeric_limits<double>::infinity(),
                                  double high = std::numeric_limits<double>::infinity()) {
    return {.name = name, .kind = Kind::Numbers, .low = low, .high = high, .count = count};
}
inline constexpr Property text(std::string_view name, bool is_required = false) {
    return {.name = name, .kind = Kind::Text, .is_required = is_required};
}
inline constexpr double endless = std::numeric_limits<double>::infinity();

}  // namespace darkroom::scene::gltf
