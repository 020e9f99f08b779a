// Arrays of numpy as arguments and results. Arguments are taken as they are, without a copy: what has another type,
// shape or layout, or is not finite, is an exception that names the argument and what is expected of it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <vector>

#include "Common/Image/Image.h"
#include "Common/Shared/Base/Types.h"
#include "Python/Activity.h"

namespace rt::python {

// What the numbers of an argument must be beyond finite.
enum class Demand {
    Finite,
    UnitOr0,  // rows are vectors of length 1, or 0 for none
    Fraction, // in [0, 1)
    Distance  // at least 0, or infinite
};

// N rows of floats; one row stands for as many as the other arguments have.
class Rows {
  public:
    // `width`: of a row; 0: the argument is a number, or has a number for each row. Throws TypeError or ValueError.
    Rows(const pybind11::object& argument, const char* name, std::size_t width, Demand demand = Demand::Finite);

    const char* name() const { return name_; }
    bool isOne() const { return isOne_; }
    std::size_t count() const { return count_; }
    const float* row(std::size_t i) const { return data_ + (isOne_ ? 0 : i * stride_); }
    float number(std::size_t i) const { return *row(i); }
    shared::vec2 vec2(std::size_t i) const { return {row(i)[0], row(i)[1]}; }
    shared::vec3 vec3(std::size_t i) const { return {row(i)[0], row(i)[1], row(i)[2]}; }

  private:
    const char* name_;
    pybind11::object owner_; // of the floats, unless there is one number
    const float* data_ = nullptr;
    float single_ = 0;
    std::size_t stride_ = 1, count_ = 1;
    bool isOne_ = false;
};

// The number of rows that all have, but for those of one row. Throws ValueError naming two that differ.
std::size_t commonCount(std::initializer_list<const Rows*> arguments);

// A whole number, or a uint32 array of shape (N,).
class Words {
  public:
    Words(const pybind11::object& argument, const char* name);

    const char* name() const { return name_; }
    bool isOne() const { return isOne_; }
    std::size_t count() const { return count_; }
    std::uint32_t at(std::size_t i) const { return isOne_ ? single_ : data_[i]; }

  private:
    const char* name_;
    pybind11::object owner_;
    const std::uint32_t* data_ = nullptr;
    std::uint32_t single_ = 0;
    std::size_t count_ = 1;
    bool isOne_ = false;
};
std::size_t commonCount(std::initializer_list<const Words*> arguments);

// A whole number below `count`; `of`: "the scene's lights". Throws TypeError or ValueError.
std::size_t indexArgument(const pybind11::object& argument, const char* name, std::size_t count, const char* of);

// A new array of shape (N, width), or (N,) for a width of 0, and where its numbers go.
template <class T>
struct NewArray {
    pybind11::array_t<T> array;
    T* data;
    std::size_t width;

    explicit NewArray(std::size_t count, std::size_t rowWidth = 0)
        : array(rowWidth == 0 ? std::vector<pybind11::ssize_t>{static_cast<pybind11::ssize_t>(count)}
                              : std::vector<pybind11::ssize_t>{static_cast<pybind11::ssize_t>(count),
                                                               static_cast<pybind11::ssize_t>(rowWidth)}),
          data(array.mutable_data()),
          width(rowWidth == 0 ? 1 : rowWidth) {}
    void set(std::size_t i, T value) { data[i] = value; }
    void set(std::size_t i, const shared::vec2& v) {
        for (int c = 0; c < 2; ++c) data[2 * i + static_cast<std::size_t>(c)] = v[c];
    }
    void set(std::size_t i, const shared::vec3& v) {
        for (int c = 0; c < 3; ++c) data[3 * i + static_cast<std::size_t>(c)] = v[c];
    }
};
using NewFloats = NewArray<float>;

inline bool isZero(const shared::vec3& v) {
    return v.x == 0.0f && v.y == 0.0f && v.z == 0.0f;
}

// Calls fill(i) for each row, while other threads may run Python.
template <class Fill>
void forEachRow(std::size_t count, const Fill& fill) {
    const Released released;
    for (std::size_t i = 0; i < count; ++i) fill(i);
}

// float32 array of shape (height, width, channels), or (height, width) of one channel; it owns the image, of which
// nothing is copied.
pybind11::array toArray(image::Image image);

// A copy: what takes images keeps them. Throws TypeError or ValueError; values need not be finite.
image::Image toImage(const pybind11::object& argument, const char* name);

} // namespace rt::python
