#include "Python/Arrays.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "Common/Image/Film.h"

namespace rt::python {
namespace {

namespace py = pybind11;

constexpr float kUnitTolerance = 1e-3f; // of a squared length

std::string shapeText(const py::array& array) {
    std::string text = "(";
    for (py::ssize_t i = 0; i < array.ndim(); ++i)
        text += (i > 0 ? ", " : "") + std::to_string(array.shape(i)) + (array.ndim() == 1 ? "," : "");
    return text + ")";
}

std::string typeText(const py::object& object) {
    if (py::isinstance<py::array>(object)) {
        const auto array = py::reinterpret_borrow<py::array>(object);
        return std::string(py::str(array.dtype())) + " array of shape " + shapeText(array);
    }
    return py::str(py::type::of(object).attr("__name__"));
}

// "points: expected a float32 array of shape (N, 3) or (3,); got ..."
std::string unexpected(const char* name, const std::string& expected, const std::string& got) {
    return std::string(name) + ": expected " + expected + "; got " + got;
}

std::string demandText(Demand demand) {
    switch (demand) {
        case Demand::UnitOr0:
            return "vectors of length 1 or 0";
        case Demand::Fraction:
            return "numbers from 0 to below 1";
        case Demand::Distance:
            return "numbers of at least 0";
        case Demand::Finite:
            break;
    }
    return "finite numbers";
}

bool isAsDemanded(const float* row, std::size_t width, Demand demand) {
    float squared = 0;
    for (std::size_t c = 0; c < width; ++c) {
        const float x = row[c];
        if (std::isnan(x) || (std::isinf(x) && demand != Demand::Distance)) return false;
        if (demand == Demand::Fraction && !(x >= 0 && x < 1)) return false;
        if (demand == Demand::Distance && !(x >= 0)) return false;
        squared += x * x;
    }
    if (demand == Demand::UnitOr0 && squared == 0) return true;
    return demand != Demand::UnitOr0 || std::abs(squared - 1) <= kUnitTolerance;
}

// Whether all numbers, of rows that need not be vectors, are as demanded: by their bits, which compilers make vectors
// of. False also where only a closer look tells, as at -0.
bool areSurelyAsDemanded(const float* numbers, std::size_t count, Demand demand) {
    if (demand == Demand::UnitOr0) return false;
    const bool isFraction = demand == Demand::Fraction;
    const std::uint32_t mask = isFraction ? 0xffffffffu : 0x7fffffffu; // the sign is free, or must not be there
    const std::uint32_t end = isFraction ? 0x3f800000u : 0x7f800000u;  // 1, or infinity
    std::uint32_t others = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t bits = std::bit_cast<std::uint32_t>(numbers[i]) & mask;
        others |= static_cast<std::uint32_t>(bits >= end);
    }
    return others == 0 && demand != Demand::Distance;
}

std::string rowText(const float* row, std::size_t width) {
    std::string text;
    for (std::size_t c = 0; c < width; ++c) text += (c > 0 ? ", " : "") + std::string(py::str(py::float_(row[c])));
    return width == 1 ? text : "(" + text + ")";
}

// A whole number, be it Python's or numpy's, as a Python integer; nothing: it is none.
py::object wholeNumber(const py::object& argument) {
    if (py::isinstance<py::array>(argument) || PyIndex_Check(argument.ptr()) == 0) return {};
    PyObject* const whole = PyNumber_Index(argument.ptr());
    if (whole == nullptr) throw py::error_already_set();
    return py::reinterpret_steal<py::object>(whole);
}

// -1: not from 0 to 2^63 - 1.
std::int64_t positiveOf(const py::object& whole) {
    int overflow = 0;
    const long long value = PyLong_AsLongLongAndOverflow(whole.ptr(), &overflow);
    return overflow != 0 || value < 0 ? -1 : value;
}

// Also a whole one, or a scalar of numpy; beyond the range of float it is infinite.
bool isNumber(const py::object& argument) {
    if (py::isinstance<py::array>(argument)) return false;
    return py::isinstance<py::float_>(argument) || wholeNumber(argument) ||
           py::isinstance(argument, py::module_::import("numpy").attr("floating"));
}

float toFloat(const py::object& number) {
    constexpr float kInfinite = std::numeric_limits<float>::infinity();
    const double value = PyFloat_AsDouble(number.ptr());
    if (PyErr_Occurred() != nullptr) { // a whole number beyond the range of double
        PyErr_Clear();
        return number < py::int_(0) ? -kInfinite : kInfinite;
    }
    if (std::abs(value) > std::numeric_limits<float>::max()) return value < 0 ? -kInfinite : kInfinite;
    return static_cast<float>(value);
}

// Of this type and contiguous. `expected`: "a float32 array of shape (N, 3)".
template <class T>
py::array_t<T> plainArray(const py::object& argument, const char* name, const std::string& expected) {
    if (!py::isinstance<py::array>(argument)) throw py::type_error(unexpected(name, expected, typeText(argument)));
    if (!py::isinstance<py::array_t<T>>(argument))
        throw py::type_error(unexpected(name, expected, typeText(argument)) + "; numpy.asarray converts");
    auto array = py::reinterpret_borrow<py::array_t<T>>(argument);
    const bool isAligned = reinterpret_cast<std::uintptr_t>(array.data()) % alignof(T) == 0;
    if (!(array.flags() & py::array::c_style) || !isAligned)
        throw py::value_error(unexpected(name, expected, "one that is not contiguous") +
                              "; numpy.ascontiguousarray makes it so");
    return array;
}

} // namespace

Rows::Rows(const py::object& argument, const char* name, std::size_t width, Demand demand) : name_(name) {
    const std::size_t values = std::max<std::size_t>(width, 1);
    const std::string w = std::to_string(width);
    const std::string expected = width == 0 ? "a number or a float32 array of shape (N,)"
                                            : "a float32 array of shape (N, " + w + ") or (" + w + ",)";
    if (width == 0 && isNumber(argument)) {
        single_ = toFloat(argument);
        data_ = &single_;
        isOne_ = true;
    } else {
        const auto array = plainArray<float>(argument, name, expected);
        const bool isRow = width > 0 && array.ndim() == 1 && array.shape(0) == static_cast<py::ssize_t>(width);
        const bool isTable =
            width > 0 ? array.ndim() == 2 && array.shape(1) == static_cast<py::ssize_t>(width) : array.ndim() == 1;
        if (!isRow && !isTable) throw py::value_error(unexpected(name, expected, typeText(argument)));
        owner_ = array;
        data_ = array.data();
        isOne_ = isRow;
        count_ = isRow ? 1 : static_cast<std::size_t>(array.shape(0));
        stride_ = values;
    }
    if (areSurelyAsDemanded(data_, count_ * values, demand)) return;
    for (std::size_t i = 0; i < count_; ++i)
        if (const float* at = row(i); !isAsDemanded(at, values, demand))
            throw py::value_error(unexpected(name, demandText(demand), rowText(at, values)) +
                                  (isOne_ ? "" : " in row " + std::to_string(i)));
}

namespace {

template <class Argument>
std::size_t commonCountOf(std::initializer_list<const Argument*> arguments) {
    const Argument* first = nullptr;
    for (const Argument* argument : arguments) {
        if (argument->isOne()) continue;
        if (first == nullptr) first = argument;
        if (argument->count() != first->count())
            throw py::value_error(
                unexpected(argument->name(),
                           std::to_string(first->count()) + " rows, as many as " + first->name() + " has, or one",
                           std::to_string(argument->count())));
    }
    return first == nullptr ? 1 : first->count();
}

} // namespace

std::size_t commonCount(std::initializer_list<const Rows*> arguments) {
    return commonCountOf(arguments);
}

Words::Words(const py::object& argument, const char* name) : name_(name) {
    const std::string expected = "a whole number from 0 to 2^32 - 1 or a uint32 array of shape (N,)";
    if (const py::object whole = wholeNumber(argument)) {
        const std::int64_t value = positiveOf(whole);
        if (value < 0 || value > 0xffffffffLL) throw py::value_error(unexpected(name, expected, py::str(argument)));
        single_ = static_cast<std::uint32_t>(value);
        isOne_ = true;
        return;
    }
    const auto array = plainArray<std::uint32_t>(argument, name, expected);
    if (array.ndim() != 1) throw py::value_error(unexpected(name, expected, typeText(argument)));
    owner_ = array;
    data_ = array.data();
    count_ = static_cast<std::size_t>(array.shape(0));
}

std::size_t commonCount(std::initializer_list<const Words*> arguments) {
    return commonCountOf(arguments);
}

std::size_t indexArgument(const py::object& argument, const char* name, std::size_t count, const char* of) {
    const std::string expected =
        "an index from 0 to " + std::to_string(static_cast<std::int64_t>(count) - 1) + " of " + of;
    const py::object whole = wholeNumber(argument);
    if (!whole) throw py::type_error(unexpected(name, expected, typeText(argument)));
    const std::int64_t value = positiveOf(whole);
    if (value < 0 || static_cast<std::uint64_t>(value) >= count)
        throw py::value_error(unexpected(name, expected, py::str(argument)));
    return static_cast<std::size_t>(value);
}

py::array toArray(image::Image image) {
    auto owned = std::make_unique<image::Image>(std::move(image));
    float* data = owned->data.data();
    std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(owned->height), static_cast<py::ssize_t>(owned->width)};
    if (owned->channels > 1) shape.push_back(static_cast<py::ssize_t>(owned->channels));
    const py::capsule owner(owned.get(), [](void* pointer) { delete static_cast<image::Image*>(pointer); });
    (void)owned.release();
    return py::array_t<float>(shape, data, owner);
}

image::Image toImage(const py::object& argument, const char* name) {
    const std::string expected = "a float32 array of shape (height, width, 3) or (height, width)";
    const auto array = plainArray<float>(argument, name, expected);
    const bool isGrey = array.ndim() == 2;
    if (!isGrey && !(array.ndim() == 3 && array.shape(2) == 3))
        throw py::value_error(unexpected(name, expected, typeText(argument)));
    for (int i = 0; i < 2; ++i)
        if (array.shape(i) < 1 || array.shape(i) > static_cast<py::ssize_t>(image::kMaxImageSide))
            throw py::value_error(unexpected(name, "sides from 1 to 16384 pixels", typeText(argument)));
    image::Image image(static_cast<std::uint32_t>(array.shape(1)), static_cast<std::uint32_t>(array.shape(0)),
                       isGrey ? 1 : 3);
    std::copy_n(array.data(), image.data.size(), image.data.begin());
    return image;
}

} // namespace rt::python
