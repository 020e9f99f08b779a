// The engine of a rank, on a thread of its own, so that it need not wait for messages to other ranks.
#pragma once
#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "Common/App/Ranks/RankWorker.h"
#include "Common/App/Ranks/Ranks.h"

namespace rt::app {

// From one thread to another.
template <class T>
class Queue {
  public:
    void put(T message) {
        {
            const std::scoped_lock lock(mutex_);
            messages_.push_back(std::move(message));
        }
        arrived_.notify_one();
    }
    std::optional<T> take() {
        const std::scoped_lock lock(mutex_);
        if (messages_.empty()) return std::nullopt;
        std::optional<T> message = std::move(messages_.front());
        messages_.pop_front();
        return message;
    }
    // Until there is a message.
    void wait() {
        std::unique_lock lock(mutex_);
        arrived_.wait(lock, [this] { return !messages_.empty(); });
    }
    // Until there is a message, at most so long.
    void wait(std::chrono::microseconds longest) {
        std::unique_lock lock(mutex_);
        arrived_.wait_for(lock, longest, [this] { return !messages_.empty(); });
    }

  private:
    std::mutex mutex_;
    std::condition_variable arrived_;
    std::deque<T> messages_;
};

// The engine, which is as serveLeases() requires, must be left alone while this exists.
class LocalRank {
  public:
    LocalRank(Engine& engine, const scene::CompiledScene& scene, const RenderSettings& settings)
        : processorsRender_(engine.report().threads > 0),
          link_{[this](Message message, TilesToPack tiles) { answer(std::move(message), std::move(tiles)); },
                [this] { return inbox_.take(); }, [this] { inbox_.wait(); }},
          thread_([this, &engine, &scene, settings] { serve(engine, scene, settings); }) {}
    ~LocalRank() {
        inbox_.put({MessageKind::End, nullptr, {}});
        thread_.join();
    }
    LocalRank(const LocalRank&) = delete;
    LocalRank& operator=(const LocalRank&) = delete;

    bool processorsRender() const { return processorsRender_; }
    void send(Message message) { inbox_.put(std::move(message)); }
    // Tiles are packed here, while the engine goes on with the next lease.
    std::optional<Message> receive() {
        std::optional<Outgoing> next = outbox_.take();
        if (!next) return std::nullopt;
        if (next->tiles) next->message.tiles = next->tiles();
        return std::move(next->message);
    }

    // Until there is something to receive, at most so long.
    void wait(std::chrono::microseconds longest) { outbox_.wait(longest); }

  private:
    struct Outgoing {
        Message message;
        TilesToPack tiles;
    };

    void answer(Message message, TilesToPack tiles) { outbox_.put({std::move(message), std::move(tiles)}); }

    void serve(Engine& engine, const scene::CompiledScene& scene, const RenderSettings& settings) {
        try {
            serveLeases(engine, scene, settings, link_);
        } catch (const std::exception& error) {
            outbox_.put({failureMessage(error), nullptr});
        }
    }

    bool processorsRender_;
    Queue<Message> inbox_;
    Queue<Outgoing> outbox_;
    RankLink link_;
    std::thread thread_;
};

// Takes messages from rank 0 to this rank, and back, until rank 0 ends it.
inline void connect(LocalRank& rank, Communicator& ranks) {
    IdleWait idle(rank.processorsRender());
    ranks.setProcessorsRender(rank.processorsRender());
    int leases = 0; // that the rank holds
    for (bool isEnd = false; !isEnd;) {
        bool any = false;
        for (; auto message = rank.receive(); any = true) {
            if (message->kind == MessageKind::Result) {
                --leases;
                idle.leaseTook(message->fields.at("busy"));
            }
            ranks.send(0, toBytes(std::move(*message)));
        }
        for (std::optional<Received> received; !isEnd && (received = ranks.receive()); any = true) {
            Message message = toMessage(std::move(received->message));
            isEnd = message.kind == MessageKind::End;
            if (message.kind == MessageKind::Lease) ++leases;
            rank.send(std::move(message));
        }
        if (any)
            idle.wake();
        else // without a lease the rank is idle until rank 0 is heard
            rank.wait(leases > 0 ? idle.next() : std::min<IdleWait::Time>(idle.next(), kPollInterval));
    }
}

} // namespace rt::app
