// Several functions as one, for std::visit.
#pragma once

namespace rt::bench {

template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

} // namespace rt::bench
