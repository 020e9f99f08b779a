#include "Common/App/Interactive/Mailbox.h"

namespace rt::app {

void Mailbox::post(Cancel cancel, const std::function<void(Requests&)>& change) {
    {
        const std::scoped_lock lock(mutex_);
        change(requests_);
        for (std::size_t i = 1; i <= static_cast<std::size_t>(cancel); ++i) cancelled_[i] = true;
    }
    wake_.notify_one();
}

Requests Mailbox::take(bool wait) {
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [&] { return !wait || requests_.any(); });
    for (const Cancel what : {Cancel::Slice, Cancel::FirstPicture, Cancel::Build})
        cancelled_[static_cast<std::size_t>(what)] = requests_.quit;
    return std::exchange(requests_, {});
}

bool Mailbox::moveCameraAlone() const {
    const std::scoped_lock lock(mutex_);
    return requests_.moveCameraAlone();
}

} // namespace rt::app
