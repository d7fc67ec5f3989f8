// SPDX-License-Identifier: MIT
#include "develop/stack_copy.hpp"

#include <algorithm>
#include <darkroom/effect.hpp>
#include <tuple>

#include "core/try.hpp"

namespace darkroom {

namespace {

bool is_between(float opacity) { return opacity > 0 && opacity < 1; }

/// What compile looks at, and the name.
auto wiring_of(const EntryDesc& desc) {
    return std::tie(desc.input, desc.source, desc.second, desc.mask, desc.is_ui, desc.name, desc.blend,
                    desc.scale.numerator, desc.scale.denominator, desc.format);
}

}  // namespace

StackCopy::Shape StackCopy::shape_of(const Composer& source, Handle entry, double time, const Camera& camera) {
    Shape out{.id = entry.id, .info = source.info(entry), .desc = *source.desc(entry)};
    const std::span<const std::uint32_t> words = source.words(entry);
    for (const ParamInfo& row : out.info->parameters.rows)
        if (row.is_at_compile || row.kind == Kind::Resource)
            out.words.insert(out.words.end(), words.begin() + row.word, words.begin() + row.word + row.words);
    if (is_between(source.values_at(entry, time, camera).opacity)) mixed_.insert(entry.id);
    out.is_mixable = mixed_.contains(entry.id);
    return out;
}

bool StackCopy::is_same(const Shape& a, const Shape& b) {
    return a.id == b.id && a.info == b.info && wiring_of(a.desc) == wiring_of(b.desc) && a.words == b.words &&
           a.is_mixable == b.is_mixable;
}

Result<> StackCopy::define_resources(const Composer& source, Composer& copy) {
    for (const auto& [number, resource] : resources_) copy.forget(resource);
    resources_.clear();
    for (const auto& [number, data] : source.resources()) {
        DARKROOM_TRY_VALUE(auto defined, copy.define(*data));
        resources_[number] = defined;
    }
    return {};
}

Handle StackCopy::copy_of(Handle wire) const {
    const auto entry = std::ranges::find(entries_, wire.id, [](const Pair& pair) { return pair.source.id; });
    if (entry != entries_.end()) return {entry->copy.id, wire.is_previous};
    if (const auto found = resources_.find(wire.id); found != resources_.end())
        return Composer::picture_of(found->second);
    return wire;
}

std::vector<std::uint32_t> StackCopy::copied_words(const EffectInfo& info, std::span<const std::uint32_t> words) const {
    std::vector<std::uint32_t> out(words.begin(), words.end());
    for (const ParamInfo& row : info.parameters.rows) {
        if (row.kind != Kind::Resource) continue;
        const auto found = resources_.find(out[row.word]);
        out[row.word] = found == resources_.end() ? 0 : found->second.id;
    }
    return out;
}

Result<bool> StackCopy::follow(const Composer& source, Composer& copy, double time, const Camera& camera) {
    std::vector<Shape> shapes;
    for (std::size_t i = 0; i < source.size(); ++i) shapes.push_back(shape_of(source, source.entry(i), time, camera));
    if (is_made_ && std::ranges::equal(shapes, shapes_, is_same)) return false;
    is_made_ = false;
    shapes_.clear();
    entries_.clear();
    copy.clear();
    DARKROOM_TRY(define_resources(source, copy));
    for (Shape& shape : shapes) {
        // What may be mixed is planned so.
        shape.desc.opacity = shape.is_mixable ? 0.5F : 1.0F;
        EntryDesc desc = shape.desc;
        desc.input = desc.source = desc.second = desc.mask = {};
        const auto words = copied_words(*shape.info, source.words({shape.id}));
        entries_.push_back({{shape.id}, copy.add(*shape.info, words.data(), desc)});
    }
    // A wire may name an entry behind it, of the frame before.
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        EntryDesc desc = shapes[i].desc;
        for (Handle* const wire : {&desc.input, &desc.source, &desc.second, &desc.mask}) *wire = copy_of(*wire);
        DARKROOM_TRY(copy.rewire(entries_[i].copy, desc));
    }
    shapes_ = std::move(shapes);
    return is_made_ = true;
}

Result<> StackCopy::follow_values(const Composer& source, Composer& copy, double time, const Camera& camera) const {
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const auto [from, to] = entries_[i];
        const EffectInfo& info = *shapes_[i].info;
        if (source.info(from) != &info) continue;
        const Composer::EntryValues values = source.values_at(from, time, camera);
        if (is_between(values.opacity) && !shapes_[i].is_mixable) continue;
        DARKROOM_TRY(copy.set_opacity(to, values.opacity));
        DARKROOM_TRY(copy.set_enabled(to, values.is_enabled));
        const std::vector<std::uint32_t> words = copied_words(info, values.words);
        for (const ParamInfo& row : info.parameters.rows) {
            const auto wanted = std::span(words).subspan(row.word, row.words);
            if (std::ranges::equal(wanted, copy.words(to).subspan(row.word, row.words))) continue;
            DARKROOM_TRY(copy.set(to, row.name, wanted));
        }
    }
    return {};
}

}  // namespace darkroom
