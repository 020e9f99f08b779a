// A value that lies elsewhere, as std::indirect of C++26: one that is much larger than what else may stand in its
// place.
#pragma once
#include <memory>
#include <utility>

namespace rt::scene {

template <class T>
class Indirect {
  public:
    Indirect(T value) : value_(std::make_unique<T>(std::move(value))) {}
    Indirect(const Indirect& other) : Indirect(*other) {}
    Indirect(Indirect&&) noexcept = default; // leaves nothing behind
    Indirect& operator=(Indirect other) noexcept {
        value_ = std::move(other.value_);
        return *this;
    }

    const T& operator*() const { return *value_; }
    const T* operator->() const { return value_.get(); }
    bool operator==(const Indirect& other) const { return *value_ == *other.value_; }

  private:
    std::unique_ptr<T> value_;
};

} // namespace rt::scene
