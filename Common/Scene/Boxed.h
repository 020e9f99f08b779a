// A value that lies elsewhere: one that is much larger than what else may stand in its place. Copies share it.
#pragma once
#include <memory>
#include <utility>

namespace rt::scene {

template <class T>
class Boxed {
  public:
    Boxed(T value) : value_(std::make_shared<T>(std::move(value))) {}

    const T& operator*() const { return *value_; }
    const T* operator->() const { return value_.get(); }
    // Where no copy shares it, so that nobody sees it change; null elsewhere.
    T* own() { return value_.use_count() == 1 ? value_.get() : nullptr; }
    bool operator==(const Boxed& other) const { return value_ == other.value_ || *value_ == *other.value_; }

  private:
    std::shared_ptr<T> value_;
};

} // namespace rt::scene
