// Values and records of sixteen paths, field by field: a path a lane. Loops over lanes that call what is in
// Common/Shared become vectors of lanes, if nothing in there has a branch that a compiler could not turn into a mask.
// (Copied as a whole, a record would be read in pieces larger than those in which it was written, and processors wait
// for that.) Included by one translation unit per instruction set; everything here has internal linkage.
#pragma once
#include <cstddef>
#include <type_traits>

#include "Common/Shared/Base/Types.h"

RT_SHARED_BEGIN

const uint kLanes = 16u;

// ---- scalars and vectors -------------------------------------------------------------------------------------------

struct alignas(64) FloatLanes {
    float at[kLanes];
};

struct alignas(64) UintLanes {
    uint at[kLanes];
};

struct Vec2Lanes {
    FloatLanes x, y;
};

struct Vec3Lanes {
    FloatLanes x, y, z;
};

RT_FN float get(const FloatLanes& lanes, uint i) {
    return lanes.at[i];
}
RT_FN uint get(const UintLanes& lanes, uint i) {
    return lanes.at[i];
}
RT_FN vec2 get(const Vec2Lanes& lanes, uint i) {
    return vec2(lanes.x.at[i], lanes.y.at[i]);
}
RT_FN vec3 get(const Vec3Lanes& lanes, uint i) {
    return vec3(lanes.x.at[i], lanes.y.at[i], lanes.z.at[i]);
}
RT_FN void set(FloatLanes& lanes, uint i, float v) {
    lanes.at[i] = v;
}
RT_FN void set(UintLanes& lanes, uint i, uint v) {
    lanes.at[i] = v;
}
RT_FN void set(Vec2Lanes& lanes, uint i, vec2 v) {
    lanes.x.at[i] = v.x;
    lanes.y.at[i] = v.y;
}
RT_FN void set(Vec3Lanes& lanes, uint i, vec3 v) {
    lanes.x.at[i] = v.x;
    lanes.y.at[i] = v.y;
    lanes.z.at[i] = v.z;
}

// ---- records -------------------------------------------------------------------------------------------------------

// Pointers to fields of a record.
template <auto... kFields>
struct FieldList {};

// All fields of a record: those that are kept in lanes, and those that are not since nobody reads them there.
template <class Kept, class Omitted = FieldList<>>
struct Fields {};

// Derived from the Fields of a record.
template <class Record>
struct FieldsOf;

template <class Kept, class Omitted>
struct ListedLanes;

template <class Kept, class Omitted>
ListedLanes<Kept, Omitted> lanesOfList(Fields<Kept, Omitted>);

// What sixteen values of a type are kept in.
template <class T>
struct LanesOf {
    using type = decltype(lanesOfList(FieldsOf<T>()));
};
template <>
struct LanesOf<float> {
    using type = FloatLanes;
};
template <>
struct LanesOf<uint> {
    using type = UintLanes;
};
template <>
struct LanesOf<vec2> {
    using type = Vec2Lanes;
};
template <>
struct LanesOf<vec3> {
    using type = Vec3Lanes;
};

template <class T, std::size_t kCount>
struct ArrayLanes {
    typename LanesOf<T>::type at[kCount];
};
template <class T, std::size_t kCount>
struct LanesOf<T[kCount]> {
    using type = ArrayLanes<T, kCount>;
};

template <class Pointer>
struct Member;
template <class T, class Owner>
struct Member<T Owner::*> {
    using Type = T;
    using Record = Owner;
};

// The lanes of one field.
template <auto kField>
struct FieldLanes {
    typename LanesOf<typename Member<decltype(kField)>::Type>::type lanes;
};

template <auto... kFields>
inline constexpr std::size_t kSizeOfFields = (sizeof(typename Member<decltype(kFields)>::Type) + ... + 0u);

template <auto kFirst, auto... kFields, auto... kOmitted>
struct ListedLanes<FieldList<kFirst, kFields...>, FieldList<kOmitted...>> : FieldLanes<kFirst>, FieldLanes<kFields>... {
    using Record = typename Member<decltype(kFirst)>::Record;
    static_assert(kSizeOfFields<kFirst, kFields..., kOmitted...> == sizeof(Record),
                  "FieldsOf<Record> must list every field of the record, kept or omitted, once");
};

// Sixteen records.
template <class Record>
using RecordLanes = typename LanesOf<Record>::type;

// The lanes of one field: lanesOf<&Vertex::origin>(vertices).
template <auto kField, class Lanes>
RT_FN auto& lanesOf(Lanes& lanes) {
    using Field = std::conditional_t<std::is_const_v<Lanes>, const FieldLanes<kField>, FieldLanes<kField>>;
    return static_cast<Field&>(lanes).lanes;
}

template <class T, class Lanes>
RT_FN void read(const Lanes& lanes, uint i, T& field) {
    field = get(lanes, i);
}
template <class T, std::size_t kCount>
RT_FN void read(const ArrayLanes<T, kCount>& lanes, uint i, T (&field)[kCount]) {
    for (std::size_t k = 0u; k < kCount; ++k) field[k] = get(lanes.at[k], i);
}
template <class T, std::size_t kCount>
RT_FN void set(ArrayLanes<T, kCount>& lanes, uint i, const T (&field)[kCount]) {
    for (std::size_t k = 0u; k < kCount; ++k) set(lanes.at[k], i, field[k]);
}

// Reads the fields that are kept, one by one: a copy of a whole record inside another keeps compilers from making
// vectors of lanes.
template <auto... kFields, class Omitted>
RT_FN void read(const ListedLanes<FieldList<kFields...>, Omitted>& lanes, uint i,
                typename ListedLanes<FieldList<kFields...>, Omitted>::Record& record) {
    (read(lanesOf<kFields>(lanes), i, record.*kFields), ...);
}

// The record in a lane, zero where a field is omitted; compilers read no more of it than is used.
template <auto... kFields, class Omitted>
RT_FN auto get(const ListedLanes<FieldList<kFields...>, Omitted>& lanes, uint i) {
    typename ListedLanes<FieldList<kFields...>, Omitted>::Record record{};
    read(lanes, i, record);
    return record;
}

template <auto... kFields, class Omitted>
RT_FN void set(ListedLanes<FieldList<kFields...>, Omitted>& lanes, uint i,
               const typename ListedLanes<FieldList<kFields...>, Omitted>::Record& record) {
    (set(lanesOf<kFields>(lanes), i, record.*kFields), ...);
}

RT_SHARED_END
