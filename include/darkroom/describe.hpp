// SPDX-License-Identifier: MIT
#pragma once
// A parameter is described once, in the source of the effect whose struct holds it. Who only sets parameters does not
// include this: it costs a compiler more than all the rest.
//
//     struct Vignette {                        // vignette.hpp
//         float intensity = 0.3f;
//         float smoothness = 2.0f;
//     };
//
//     constexpr auto vignette_rows = describe(  // vignette.cpp
//         field<&Vignette::intensity>("Darkening of the corners.", {0, 1}),
//         field<&Vignette::smoothness>("Exponent of the falloff.", {0.1, 16}));
//
// A forgotten, doubled or misordered member, a default outside its range and a row without a sentence do not compile.

#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <darkroom/name_of.hpp>
#include <darkroom/param.hpp>
#include <string_view>
#include <type_traits>
#include <utility>

namespace darkroom {

namespace detail {

/// Not constexpr: a description that calls it is no constant and does not compile, and the compiler shows the sentence.
/// A throw would do the same, but not in a host that is compiled without exceptions.
[[noreturn]] inline void refuse(const char* /*why*/) { std::abort(); }

template <auto M>
struct Member;
template <class O, class T, T O::*M>
struct Member<M> {
    using Owner = O;
    using Type = T;
};

static_assert(name_of<&Rgb::g>() == "g" && name_of<Scale::Log>() == "Log" && name_of<Range>() == "Range");
static_assert(Enumerators<Scale>::count == 2 && Enumerators<Scale>::names[1] == "log");

template <class T>
constexpr Kind kind_of() {
    if constexpr (std::is_same_v<T, float>) {
        return Kind::Float;
    } else if constexpr (std::is_same_v<T, std::int32_t>) {
        return Kind::Int;
    } else if constexpr (std::is_same_v<T, Toggle>) {
        return Kind::Toggle;
    } else if constexpr (std::is_same_v<T, Vec2>) {
        return Kind::Vec2;
    } else if constexpr (std::is_same_v<T, Vec3>) {
        return Kind::Vec3;
    } else if constexpr (std::is_same_v<T, Vec4>) {
        return Kind::Vec4;
    } else if constexpr (std::is_same_v<T, Rgb>) {
        return Kind::Rgb;
    } else if constexpr (std::is_same_v<T, Curve>) {
        return Kind::Curve;
    } else if constexpr (std::is_same_v<T, Resource>) {
        return Kind::Resource;
    } else {
        static_assert(std::is_enum_v<T> && sizeof(T) == 4, "not a type that a parameter may have");
        return Kind::Choice;
    }
}

template <class T>
using Words = std::array<std::uint32_t, sizeof(T) / 4>;

// Where a member lies: change it and see which word of the struct changed.
template <auto M>
constexpr std::uint32_t word_of() {
    using Owner = typename Member<M>::Owner;
    using Type = typename Member<M>::Type;
    Owner changed{};
    auto words = std::bit_cast<Words<Type>>(changed.*M);
    for (auto& word : words) word = ~word;
    changed.*M = std::bit_cast<Type>(words);
    const auto before = std::bit_cast<Words<Owner>>(Owner{}), after = std::bit_cast<Words<Owner>>(changed);
    std::uint32_t i = 0;
    while (before[i] == after[i]) ++i;
    return i;
}

template <class T>
constexpr bool has_range() {
    return std::is_same_v<T, float> || std::is_same_v<T, std::int32_t> || std::is_same_v<T, Vec2> ||
           std::is_same_v<T, Vec3> || std::is_same_v<T, Vec4> || std::is_same_v<T, Rgb> || std::is_same_v<T, Curve>;
}

template <class T>
constexpr bool is_inside(const T& value, const Range& range) {
    const auto ok = [&](double v) { return v >= range.min && v <= range.max; };
    if constexpr (std::is_same_v<T, float> || std::is_same_v<T, std::int32_t>) {
        return ok(static_cast<double>(value));
    } else if constexpr (std::is_same_v<T, Curve>) {
        for (std::uint32_t i = 0; i < value.count; ++i)
            if (!ok(value.y[i]) || (i > 0 && !(value.x[i] > value.x[i - 1]))) return false;
        return value.count <= Curve::capacity;
    } else {
        for (const float v : std::bit_cast<std::array<float, sizeof(T) / 4>>(value))
            if (!ok(v)) return false;
        return true;
    }
}

}  // namespace detail

template <auto M>
struct Field {
    ParamInfo info;
    template <class Change>
    [[nodiscard]] constexpr Field with(const Change& change) const {
        Field copy = *this;
        change(copy.info);
        return copy;
    }
    /// The effect's main amount: in a flat table or on the command line a value above 0 turns the effect on, 0 off.
    [[nodiscard]] constexpr Field as_amount() const {
        return with([&](ParamInfo& row) { row.is_amount = true; });
    }
    /// The amount of a part of the effect: a value above 0 on the command line turns that part's toggle on, and the
    /// effect with it.
    template <auto Part>
    [[nodiscard]] constexpr Field as_amount_of() const {
        static_assert(std::is_same_v<typename detail::Member<Part>::Type, Toggle>);
        return with([&](ParamInfo& row) { row.switched_word = detail::word_of<Part>(); });
    }
    /// A size in pixels, which may be given in % of the picture's height, too: that sets this member to Reach::Height.
    template <auto Kept>
    [[nodiscard]] constexpr Field as_size_of() const {
        static_assert(std::is_same_v<typename detail::Member<Kept>::Type, Reach>);
        return with([&](ParamInfo& row) { row.reach_word = detail::word_of<Kept>(); });
    }
    /// How often a loop of a shader runs: kernels of the present values hold it as a literal, so that compilers can
    /// unroll the loop and fold what follows from its number. For integers of at most 8 bits that are seldom animated.
    [[nodiscard]] constexpr Field as_loop_count() const {
        static_assert(std::is_same_v<typename detail::Member<M>::Type, std::int32_t>);
        if (info.range.min < 0 || info.range.max > 255) detail::refuse("a loop count lies in [0, 255]");
        return with([&](ParamInfo& row) { row.is_loop_count = true; });
    }
    /// A resource that is a picture, whose numbers are taken as its file has them, and not a table of colours.
    [[nodiscard]] constexpr Field as_picture() const {
        static_assert(std::is_same_v<typename detail::Member<M>::Type, Resource>);
        return with([&](ParamInfo& row) { row.is_picture = true; });
    }
    /// An effect's `build` chooses passes, images or tables by the value, so a change takes full effect with the next
    /// compile. Resources are always such; build sees the defaults of all other rows.
    [[nodiscard]] constexpr Field at_compile() const {
        return with([&](ParamInfo& row) { row.is_at_compile = true; });
    }
    /// A name under which consoles find it, too: of the first entry of a stack that has it.
    [[nodiscard]] constexpr Field also_named(std::string_view name, bool is_archived = false) const {
        return with([&](ParamInfo& row) {
            row.also = name;
            row.is_archived = is_archived;
        });
    }
    [[nodiscard]] constexpr Field formerly(std::string_view name) const {
        return with([&](ParamInfo& row) { row.formerly = name; });
    }
};

/// One row. The name and the default are read from the struct; sentence, range and unit are said here.
template <auto M>
constexpr Field<M> field(std::string_view doc, Range range = {}, Unit unit = unit::none) {
    using Owner = typename detail::Member<M>::Owner;
    using Type = typename detail::Member<M>::Type;
    if (doc.empty() || doc.back() != '.') detail::refuse("the doc of a parameter is a sentence");
    if constexpr (detail::has_range<Type>()) {
        if (!(range.min < range.max)) detail::refuse("the range is empty");
        if (range.scale == Scale::Log && range.min <= 0) detail::refuse("a log range starts above zero");
        if (!detail::is_inside(Owner{}.*M, range)) detail::refuse("the default lies outside the range");
    }
    ParamInfo info{.name = detail::name_of<M>(),
                   .doc = doc,
                   .unit = unit,
                   .range = range,
                   .kind = detail::kind_of<Type>(),
                   .is_at_compile = std::is_same_v<Type, Resource>,
                   .word = detail::word_of<M>(),
                   .words = sizeof(Type) / 4};
    if constexpr (std::is_enum_v<Type>) info.choices = detail::Enumerators<Type>::names;
    return {info};
}

/// The rows of a whole struct; converts to a ParamTable that refers to it, so keep it in static storage.
template <class Owner, std::size_t Count>
struct Description {
    std::array<ParamInfo, Count> rows{};
    detail::Words<Owner> defaults = std::bit_cast<detail::Words<Owner>>(Owner{});
    [[nodiscard]] constexpr ParamTable table() const { return {detail::name_of<Owner>(), rows, defaults}; }
};

/// Compiles only if every member is described exactly once and in order.
template <auto... M>
constexpr auto describe(Field<M>... fields) {
    using Owner = std::common_type_t<typename detail::Member<M>::Owner...>;
    static_assert(std::is_trivially_copyable_v<Owner> && std::is_standard_layout_v<Owner> && alignof(Owner) == 4);
    static_assert((sizeof(typename detail::Member<M>::Type) + ...) == sizeof(Owner),
                  "a member is missing from the description, or is described twice");
    Description<Owner, sizeof...(M)> out;
    std::uint32_t next = 0;
    std::size_t i = 0;
    for (const ParamInfo& info : {fields.info...}) {
        if (info.word != next) detail::refuse("describe the members in the order they are declared");
        next += info.words;
        out.rows[i++] = info;
    }
    return out;
}

}  // namespace darkroom
