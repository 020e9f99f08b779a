// That a frame of the interface is given what it can take, in order, and nothing twice.
#include <string>
#include <vector>

#include <gtest/gtest.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "Common/Gui/InputQueue.h"

namespace rt::gui {
namespace {

using Kind = InputEvent::Kind;
using Portion = std::vector<InputEvent>;

InputEvent keyEvent(int code, bool isDown, int modifiers = 0) {
    return {Kind::Key, code, 0, modifiers, isDown};
}
InputEvent textEvent(char character) {
    return {Kind::Text, character};
}
InputEvent moveEvent(double x) {
    return {Kind::Move, 0, 0, 0, false, x, 0};
}
InputEvent buttonEvent(bool isDown) {
    return {Kind::Button, GLFW_MOUSE_BUTTON_LEFT, 0, 0, isDown};
}
InputEvent wheelEvent() {
    return {Kind::Wheel, 0, 0, 0, false, 0, 1};
}

// Of keys that are pressed, bring their letter and are let go.
Portion typed(const std::string& word) {
    Portion events;
    for (const char letter : word) {
        const int key = GLFW_KEY_A + (letter - 'a');
        events.insert(events.end(), {keyEvent(key, true), textEvent(letter), keyEvent(key, false)});
    }
    return events;
}

std::vector<Portion> portionsOf(const Portion& events, bool isTyping) {
    InputQueue queue;
    for (const InputEvent& event : events) queue.push(event);
    std::vector<Portion> portions;
    while (!queue.isEmpty()) portions.push_back(queue.take(isTyping));
    return portions;
}

Portion joined(const std::vector<Portion>& portions) {
    Portion all;
    for (const Portion& portion : portions) all.insert(all.end(), portion.begin(), portion.end());
    return all;
}

TEST(InputQueue, AWordGoesToAFieldAtOnceAndElsewhereKeyByKey) {
    EXPECT_EQ(portionsOf(typed("aab"), true), (std::vector<Portion>{typed("aab")}));
    const std::vector<Portion> keys = portionsOf(typed("aab"), false);
    EXPECT_EQ(keys.size(), 6u) << "each press with its letter, each release";
    EXPECT_EQ(joined(keys), typed("aab"));
}

// ImGui reads the letters of a frame before its keys, and none while Ctrl is down.
TEST(InputQueue, CommandsAndLettersShareNoFrame) {
    const InputEvent control = keyEvent(GLFW_KEY_LEFT_CONTROL, true),
                     noControl = keyEvent(GLFW_KEY_LEFT_CONTROL, false, GLFW_MOD_CONTROL),
                     all = keyEvent(GLFW_KEY_A, true, GLFW_MOD_CONTROL),
                     noAll = keyEvent(GLFW_KEY_A, false, GLFW_MOD_CONTROL), back = keyEvent(GLFW_KEY_BACKSPACE, true),
                     noBack = keyEvent(GLFW_KEY_BACKSPACE, false);
    Portion events = {control, all, noAll, noControl};
    const Portion first = typed("proc"), second = typed("x");
    events.insert(events.end(), first.begin(), first.end());
    events.insert(events.end(), {back, noBack});
    events.insert(events.end(), second.begin(), second.end());
    const std::vector<Portion> expected = {{control}, {all}, {noAll}, {noControl}, first, {back}, {noBack}, second};
    EXPECT_EQ(portionsOf(events, true), expected);
}

TEST(InputQueue, EachChangeOfAButtonHasAFrameWithThePlaceWhereItWasMade) {
    const Portion events = {moveEvent(1), moveEvent(2),       buttonEvent(true), moveEvent(3),
                            moveEvent(4), buttonEvent(false), buttonEvent(true), buttonEvent(false),
                            moveEvent(5), wheelEvent(),       wheelEvent(),      moveEvent(6)};
    const std::vector<Portion> expected = {{moveEvent(2), buttonEvent(true)},
                                           {moveEvent(4), buttonEvent(false)},
                                           {buttonEvent(true)},
                                           {buttonEvent(false)},
                                           {moveEvent(5), wheelEvent(), wheelEvent()},
                                           {moveEvent(6)}};
    EXPECT_EQ(portionsOf(events, false), expected);
    EXPECT_EQ(portionsOf(events, true), expected);
}

TEST(InputQueue, WhatMayBringTheKeyboardElsewhereIsAnsweredFirst) {
    EXPECT_TRUE(InputQueue::mayChangeFocus({keyEvent(GLFW_KEY_TAB, true)}));
    EXPECT_TRUE(InputQueue::mayChangeFocus({keyEvent(GLFW_KEY_O, true, GLFW_MOD_CONTROL)}));
    EXPECT_TRUE(InputQueue::mayChangeFocus({moveEvent(1), buttonEvent(true)}));
    EXPECT_FALSE(InputQueue::mayChangeFocus({keyEvent(GLFW_KEY_TAB, false)}));
    EXPECT_FALSE(InputQueue::mayChangeFocus(typed("word")));
    EXPECT_FALSE(InputQueue::mayChangeFocus({moveEvent(1), wheelEvent()}));
    EXPECT_FALSE(InputQueue::mayChangeFocus({}));
}

} // namespace
} // namespace rt::gui
