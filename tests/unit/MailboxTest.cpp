// What a window asks for while its session's thread is at work: what counts, and what is given up for it.
#include <gtest/gtest.h>

#include "Common/App/Interactive/Mailbox.h"

namespace rt::app {
namespace {

void moveTo(Mailbox& mailbox, double x) {
    mailbox.post(Cancel::Slice, [x](Requests& requests) {
        scene::CameraDesc camera;
        camera.lookFrom.x = x;
        requests.camera.emplace(1, camera);
    });
}

TEST(Mailbox, TheLastOfAKindCountsAndEachFileDoes) {
    Mailbox mailbox;
    moveTo(mailbox, 1);
    moveTo(mailbox, 2);
    EXPECT_TRUE(mailbox.moveCameraAlone());
    mailbox.post(Cancel::Nothing, [](Requests& requests) { requests.saves.push_back({.files = {"a.png"}}); });
    mailbox.post(Cancel::Nothing, [](Requests& requests) { requests.saves.push_back({.files = {"b.png"}}); });
    EXPECT_FALSE(mailbox.moveCameraAlone());
    const Requests taken = mailbox.take();
    EXPECT_EQ(taken.camera->second.lookFrom.x, 2);
    EXPECT_EQ(taken.saves.size(), 2u);
    EXPECT_FALSE(mailbox.take().any());
}

TEST(Mailbox, ARequestCancelsWhatItSaysUntilItIsTaken) {
    Mailbox mailbox;
    const auto cancelled = [&](Cancel what) { return mailbox.cancelled(what).load(); };
    mailbox.post(Cancel::Nothing, [](Requests& requests) { requests.command = Requests::Command::Render; });
    EXPECT_FALSE(cancelled(Cancel::Slice));
    moveTo(mailbox, 1);
    EXPECT_TRUE(cancelled(Cancel::Slice));
    EXPECT_FALSE(cancelled(Cancel::FirstPicture)); // a camera in motion shows pictures
    mailbox.post(Cancel::FirstPicture, [](Requests& requests) { requests.command = Requests::Command::Stop; });
    EXPECT_TRUE(cancelled(Cancel::FirstPicture));
    EXPECT_FALSE(cancelled(Cancel::Build));
    (void)mailbox.take();
    EXPECT_FALSE(cancelled(Cancel::Slice));
    EXPECT_FALSE(cancelled(Cancel::FirstPicture));
    mailbox.post(Cancel::Build, [](Requests& requests) { requests.dropsScene = true; });
    EXPECT_TRUE(cancelled(Cancel::Build));
    (void)mailbox.take();
    EXPECT_FALSE(cancelled(Cancel::Build)); // the next one is to be built
    mailbox.post(Cancel::Build, [](Requests& requests) { requests.quit = true; });
    (void)mailbox.take();
    for (const Cancel what : {Cancel::Slice, Cancel::FirstPicture, Cancel::Build}) EXPECT_TRUE(cancelled(what));
}

TEST(Mailbox, TellsOfRequestsAndOfNothingElse) {
    int posts = 0;
    Mailbox mailbox([&] { ++posts; });
    EXPECT_FALSE(mailbox.hasRequests());
    moveTo(mailbox, 3);
    EXPECT_EQ(posts, 1);
    EXPECT_TRUE(mailbox.hasRequests());
    EXPECT_FALSE(mailbox.isAskedToQuit());
    EXPECT_EQ(mailbox.take().camera->second.lookFrom.x, 3);
    mailbox.interrupt(Cancel::Build); // asks for nothing
    EXPECT_TRUE(mailbox.cancelled(Cancel::Build));
    EXPECT_FALSE(mailbox.hasRequests());
    (void)mailbox.take();
    EXPECT_FALSE(mailbox.cancelled(Cancel::Build));
    mailbox.post(Cancel::Build, [](Requests& requests) { requests.quit = true; });
    EXPECT_TRUE(mailbox.isAskedToQuit());
}

TEST(Mailbox, FilesNeedNoEngine) {
    Requests requests;
    requests.saves.push_back({});
    requests.atEnd.emplace();
    EXPECT_TRUE(requests.any());
    EXPECT_FALSE(requests.needEngine());
    requests.view.emplace();
    EXPECT_TRUE(requests.needEngine());
    EXPECT_FALSE(requests.changeWhatIsSeen());
}

} // namespace
} // namespace rt::app
