// An error that Alone.cmake must find: this does not include what it uses, Common/Core/Error.h.
#include "Common/Core/Printable.h"

namespace rt {

void throwPlanted() {
    throw RenderError("planted");
}

} // namespace rt
