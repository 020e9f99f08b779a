#include "Common/App/Interactive/Mailbox.h"

namespace rt::app {

void Mailbox::post(Cancel cancel, const std::function<void(Requests&)>& change) {
    {
        const std::scoped_lock lock(mutex_);
        change(requests_);
        for (std::size_t i = 1; i <= static_cast<std::size_t>(cancel); ++i) cancelled_[i] = true;
    }
    if (onPost_) onPost_();
}

void Mailbox::interrupt(Cancel cancel) {
    post(cancel, [](Requests&) {});
}

Requests Mailbox::take() {
    const std::scoped_lock lock(mutex_);
    for (const Cancel what : {Cancel::Slice, Cancel::FirstPicture, Cancel::Build})
        cancelled_[static_cast<std::size_t>(what)] = requests_.quit;
    return std::exchange(requests_, {});
}

bool Mailbox::hasRequests() const {
    const std::scoped_lock lock(mutex_);
    return requests_.any();
}

bool Mailbox::isAskedToQuit() const {
    const std::scoped_lock lock(mutex_);
    return requests_.quit;
}

bool Mailbox::moveCameraAlone() const {
    const std::scoped_lock lock(mutex_);
    return requests_.moveCameraAlone();
}

} // namespace rt::app
