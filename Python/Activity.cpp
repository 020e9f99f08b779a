#include "Python/Activity.h"

#include <optional>
#include <set>
#include <thread>

#include "Common/Core/Interruption.h"
#include "Python/Bindings.h"

namespace rt::python {
namespace {

namespace py = pybind11;

constexpr auto kBetweenLooks = std::chrono::milliseconds(100);
constexpr auto kBetweenCounts = std::chrono::milliseconds(5);

std::atomic<bool> isEnding{false};
std::atomic<int> activities{0};
thread_local int ownActivities = 0;
std::thread::id endingThread; // once isEnding
// Guarded by the interpreter's lock: a mutex that another thread holds would stay locked in a forked process.
std::multiset<std::atomic<bool>*>& cancels() {
    static auto* const all = new std::multiset<std::atomic<bool>*>; // outlives the threads
    return *all;
}

// For `with`.
class HeldActivity {
  public:
    void enter() { activity_.emplace(); }
    void exit(const py::args&) { activity_.reset(); }

  private:
    std::optional<Activity> activity_;
};

// The interpreter ends: so does all work, and none begins any more.
void endActivities() {
    endingThread = std::this_thread::get_id();
    isEnding = true;
    for (std::atomic<bool>* cancel : cancels()) *cancel = true;
    const py::gil_scoped_release released;
    while (activities > ownActivities) std::this_thread::sleep_for(kBetweenCounts);
}

// In a forked process: the other threads are not in it.
void forgetActivities() {
    activities = ownActivities;
    cancels().clear();
}

} // namespace

Activity::Activity(std::atomic<bool>* cancel) : cancel_(cancel) {
    const bool isCalledOff = threadMustEnd();
    if (isCalledOff && ownActivities == 0) {
        PyErr_SetNone(PyExc_SystemExit);
        throw py::error_already_set();
    }
    if (cancel_ != nullptr) {
        cancels().insert(cancel_);
        if (isCalledOff) *cancel_ = true;
    }
    ++ownActivities;
    ++activities;
}

Activity::~Activity() {
    if (cancel_ != nullptr)
        if (const auto own = cancels().find(cancel_); own != cancels().end()) cancels().erase(own);
    --ownActivities;
    --activities;
}

bool threadMustEnd() {
    return isEnding && std::this_thread::get_id() != endingThread;
}

const std::atomic<bool>* endOfThread() {
    return isEnding && !threadMustEnd() ? nullptr : &isEnding;
}

void SignalWatch::look() {
    if (threadMustEnd()) throw Interrupted();
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < kBetweenLooks) return;
    last_ = now;
    const py::gil_scoped_acquire acquired;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

void bindActivities(py::module_& module) {
    py::class_<HeldActivity>(module, "Activity")
        .def(py::init<>())
        .def("__enter__", &HeldActivity::enter)
        .def("__exit__", &HeldActivity::exit);
    module.def("end_activities", &endActivities);
    module.def("forget_activities", &forgetActivities);
}

} // namespace rt::python
