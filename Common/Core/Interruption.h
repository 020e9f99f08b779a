// Long work of one thread, as reading a scene, that another thread may call off.
#pragma once
#include <atomic>
#include <exception>

namespace rt {

class Interrupted : public std::exception {
  public:
    const char* what() const noexcept override { return "interrupted"; }
};

// While it exists, interruptionPoint() throws on this thread once the flag is set. The flag must outlive it.
class Interruptible {
  public:
    explicit Interruptible(const std::atomic<bool>& flag) : Interruptible(&flag) {}
    explicit Interruptible(const std::atomic<bool>* flag); // null: nobody may
    ~Interruptible();
    Interruptible(const Interruptible&) = delete;
    Interruptible& operator=(const Interruptible&) = delete;

  private:
    const std::atomic<bool>* outer_;
};

const std::atomic<bool>* interruptionFlag(); // of this thread; null: nobody may call its work off

bool interruptionRequested(); // somebody waits for the end of this thread's work

// Throws Interrupted where somebody waits for the work to end, and std::bad_alloc where memory has run so short that
// the reserve (MemoryReserve.h) is gone. Cheap enough for every element of a mesh.
void interruptionPoint();

} // namespace rt
