#include "Common/Scene/Compiler/SceneHash.h"

#include <cstddef>
#include <cstring>
#include <type_traits>

namespace rt::scene {

namespace {

class Hasher {
  public:
    void word(std::uint64_t value) {
        state_ = (state_ ^ value) * 0x9e3779b97f4a7c15u;
        state_ ^= state_ >> 32;
    }
    // Records consist of 32-bit fields only, so they have no padding.
    template <typename Record>
    void array(const std::vector<Record>& records) {
        static_assert(std::is_trivially_copyable_v<Record> && alignof(Record) == 4 && sizeof(Record) % 4 == 0);
        word(records.size());
        bytes(records.data(), records.size() * sizeof(Record));
    }
    void bytes(const void* data, std::size_t size) {
        const char* at = static_cast<const char*>(data);
        for (; size >= 8; at += 8, size -= 8) {
            std::uint64_t value;
            std::memcpy(&value, at, 8);
            word(value);
        }
        std::uint64_t rest = 0;
        if (size > 0) std::memcpy(&rest, at, size);
        word(rest);
    }
    std::uint64_t result() const { return state_; }

  private:
    std::uint64_t state_ = 0x243f6a8885a308d3u;
};

} // namespace

std::uint64_t sceneHash(const CompiledScene& scene) {
    Hasher hash;
    shared::forEachSourceArray([&hash](const char*, const auto& records) { hash.array(records); }, scene);
    hash.bytes(&scene.globals, offsetof(shared::SceneGlobals, aimed)); // which follows from the rest
    return hash.result();
}

} // namespace rt::scene
