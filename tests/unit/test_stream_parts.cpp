// Parts of a stream by themselves: what times are told, what becomes of each tick, how the dial turns, who may write a ring.
#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <random>
#include <thread>

#include "sim/run/accuracy_dial.hpp"
#include "sim/run/frame_pacer.hpp"
#include "sim/stream/clock/durations.hpp"
#include "sim/stream/clock/wall_clock.hpp"
#include "sim/stream/gige/gige_stream.hpp"
#include "sim/stream/projector_table.hpp"
#include "sim/stream/queued_sink.hpp"
#include "sim/stream/ring/ring_writer.hpp"

namespace pitviper::test {
namespace {

TEST(Durations, AreThoseOfTheSortedList) {
  std::mt19937_64 random(3);
  std::lognormal_distribution<double> spread(std::log(2e6), 1.5);
  Durations d;
  std::vector<double> all;
  for (int k = 0; k < 20000; ++k) {
    const auto ns = static_cast<std::int64_t>(spread(random));
    d.add(ns);
    all.push_back(static_cast<double>(ns));
  }
  std::sort(all.begin(), all.end());
  double sum = 0.0, squares = 0.0;
  for (double x : all) sum += x;
  const double mean = sum / static_cast<double>(all.size());
  for (double x : all) squares += (x - mean) * (x - mean);
  EXPECT_NEAR(d.mean_ns() / mean, 1.0, 1e-12);
  EXPECT_NEAR(d.deviation_ns() / std::sqrt(squares / static_cast<double>(all.size() - 1)), 1.0, 1e-9);
  EXPECT_EQ(d.most_ns(), all.back());
  EXPECT_EQ(d.least_ns(), all.front());
  // A bin is 2^(1/128) wide: half of it is 0.27 %; neighbours in the list are nearer.
  for (double q : {0.01, 0.5, 0.9, 0.99, 0.999})
    EXPECT_NEAR(d.quantile_ns(q) / all[static_cast<std::size_t>(std::ceil(q * static_cast<double>(all.size()))) - 1], 1.0, 0.006) << q;
}

TEST(Durations, ALongCourseKeepsItsSumInAConstantMemory) {
  LongCourse c;
  double sum = 0.0;
  for (int k = 0; k < 100000; ++k) c.add(k % 7), sum += k % 7;
  double found = 0.0;
  std::uint64_t count = 0;
  for (const auto& p : c.pieces()) found += p.sum, count += p.count;
  EXPECT_LE(c.pieces().size(), 512u);
  EXPECT_EQ(count, 100000u);
  EXPECT_EQ(found, sum);
  EXPECT_EQ(c.pieces()[3].most, 6.0);
}

TEST(WallClock, SleepsUntilAMomentAndTellsTai) {
  const std::int64_t until = monotonic_ns() + 3000000;
  sleepUntil_ns(until);
  EXPECT_GE(monotonic_ns(), until) << "never early";
  // TAI is ahead of UTC by 37 s since 2017.
  timespec utc{};
  clock_gettime(CLOCK_REALTIME, &utc);
  EXPECT_NEAR(1e-9 * static_cast<double>(taiOf_ns(monotonic_ns())) - static_cast<double>(utc.tv_sec) - 1e-9 * static_cast<double>(utc.tv_nsec), 37.0, 0.05);
}

/// Frames put at chosen moments after their ticks; what leaves, and when.
struct Left {
  std::uint64_t sequence;
  bool late, repeated;
  std::int64_t at_ns, due_ns;
};

std::vector<Left> paced(LatePolicy policy, bool holds, const std::vector<int>& after_ms, StreamAccount& account) {
  std::vector<Left> left;
  std::mutex mutex;
  constexpr std::int64_t kPeriod = 200000000, kMs = 1000000;  // wide, so that a slow machine is not late
  const std::int64_t first = monotonic_ns() + kPeriod;
  FramePacer pacer(policy, holds, account, [&](const std::shared_ptr<const Frame>& f) {
    const std::lock_guard lock(mutex);
    left.push_back(
        {f->stamp->sequence, f->stamp->isLate, f->stamp->isRepeated, monotonic_ns(), first + static_cast<std::int64_t>(f->stamp->sequence + 1) * kPeriod});
  });
  for (std::size_t k = 0; k < after_ms.size(); ++k) {
    const std::int64_t tick = first + static_cast<std::int64_t>(k) * kPeriod;
    PacedFrame p{0, k, nullptr, tick, tick + kPeriod, tick, 0, nullptr, true};
    pacer.expect(p);
    if (after_ms[k] >= 0) {
      sleepUntil_ns(tick + after_ms[k] * kMs);
      p.frame = std::make_shared<Frame>();
      p.frame->stamp = FrameStamp{};
      p.frame->stamp->sequence = k;
      p.made_ns = monotonic_ns();
    }
    pacer.put(p);
  }
  pacer.finish();
  return left;
}

// Frame 2 comes 300 ms after its tick, 100 ms after it was due; frame 4 is never drawn.
const std::vector<int> kSome = {5, 5, 300, 105, -1, 5};

TEST(FramePacer, SendsLateFramesLateAndSaysSo) {
  StreamAccount account({"c"});
  const auto left = paced(LatePolicy::Send, false, kSome, account);
  ASSERT_EQ(left.size(), 5u);
  for (const Left& l : left) EXPECT_EQ(l.late, l.sequence == 2) << l.sequence;
  const CameraAccount a = account.of(0);
  EXPECT_EQ(a.onTime, 4u);
  EXPECT_EQ(a.late, 1u);
  EXPECT_EQ(a.dropped, 1u);
  EXPECT_EQ(a.accounted(), kSome.size());
}

TEST(FramePacer, DropsWhatIsLate) {
  StreamAccount account({"c"});
  const auto left = paced(LatePolicy::Drop, false, kSome, account);
  ASSERT_EQ(left.size(), 4u);
  for (const Left& l : left) EXPECT_FALSE(l.sequence == 2 || l.sequence == 4 || l.late);
  EXPECT_EQ(account.of(0).dropped, 2u);
  EXPECT_EQ(account.of(0).accounted(), kSome.size());
}

TEST(FramePacer, RepeatsThePictureBeforeInTime) {
  StreamAccount account({"c"});
  const auto left = paced(LatePolicy::Repeat, false, kSome, account);
  ASSERT_EQ(left.size(), 6u);
  for (const Left& l : left) {
    EXPECT_EQ(l.repeated, l.sequence == 2 || l.sequence == 4) << l.sequence;
    if (l.repeated) {
      EXPECT_GE(l.at_ns, l.due_ns) << "not before it is due";
    }
  }
  EXPECT_EQ(account.of(0).repeated, 2u);
  EXPECT_EQ(account.of(0).accounted(), kSome.size());
}

TEST(FramePacer, HoldsFramesUntilTheyAreDue) {
  StreamAccount account({"c"});
  for (const Left& l : paced(LatePolicy::Send, true, kSome, account)) {
    EXPECT_GE(l.at_ns, l.due_ns) << l.sequence;
  }
  EXPECT_EQ(account.of(0).accounted(), kSome.size());
  EXPECT_EQ(account.of(0).late, 1u);
}

TEST(AccuracyDial, TurnsCoarserWhereTicksTakeTooLongAndFinerWhereThereIsRoom) {
  constexpr std::int64_t kPeriod = 10000000;
  AccuracyDial dial({6e6, 4e6, 2e6}, kPeriod);
  EXPECT_EQ(dial.rung(), 0u);
  std::int64_t now = 0;
  const auto ticks = [&](int count, std::int64_t work) {
    for (int k = 0; k < count; ++k) dial.look(dial.rung(), work, work > kPeriod, now += kPeriod);
  };
  dial.look(0, 30000000, true, now += kPeriod);
  EXPECT_EQ(dial.rung(), 0u) << "one slow frame is no reason";
  ticks(200, 6000000);
  EXPECT_EQ(dial.rung(), 0u);
  ticks(5, 12000000);
  EXPECT_EQ(dial.rung(), 1u);
  ticks(5, 11000000);
  EXPECT_EQ(dial.rung(), 2u) << "the coarsest";
  ticks(50, 12000000);
  EXPECT_EQ(dial.rung(), 2u) << "there is nothing coarser";
  AccuracyDial slow({12e6, 9e6}, kPeriod);
  EXPECT_EQ(slow.rung(), 1u) << "it begins with what holds";
  AccuracyDial back({7e6, 4e6}, kPeriod);
  for (int k = 0; k < 4; ++k) back.look(back.rung(), 10500000, true, now += kPeriod);
  EXPECT_EQ(back.rung(), 1u);
  for (int k = 0; k < 2000; ++k) back.look(back.rung(), 4000000, false, now += kPeriod);
  EXPECT_EQ(back.rung(), 0u) << "there is room again";
  // An overload that raises what the finer one takes, and ends: it comes back.
  AccuracyDial loaded({6e6, 3e6}, kPeriod);
  for (int k = 0; k < 40; ++k) loaded.look(loaded.rung(), loaded.rung() == 0 ? 24000000 : 12000000, true, now += kPeriod);
  EXPECT_EQ(loaded.rung(), 1u);
  for (int k = 0; k < 3000; ++k) loaded.look(loaded.rung(), loaded.rung() == 0 ? 6000000 : 3000000, false, now += kPeriod);
  EXPECT_EQ(loaded.rung(), 0u);
}

Frame numbered(int number, int width, int height) {
  Frame f;
  f.camera = "c";
  f.number = number;
  f.width = width, f.height = height;
  f.layers.push_back(
      {"a.counts", "count", std::vector<float>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), static_cast<float>(number % 60000))});
  f.layers.push_back({"a.radiance", "W/(m2 sr)", std::vector<float>(f.layers[0].pixels.size(), 0.5f * static_cast<float>(number))});
  f.attributes.push_back({"calibration.a.counts.radiance_per_count", 0.25});
  f.attributes.push_back({"calibration.a.counts.radiance_at_0", -3.0});
  return f;
}

RingDesign ringDesign(const std::string& name, int width, int height) {
  return {name, "s", "c", width, height, 4, 50.0, {{"a.counts", "count", true, true, 16383}, {"a.radiance", "W/(m2 sr)", false, false, 65535}}};
}

std::string ownRing(const char* what) { return "/pitviper.test." + std::to_string(getpid()) + "." + what; }

TEST(Ring, AReaderSeesWhatWasWritten) {
  const std::string name = ownRing("sees");
  RingWriter writer(ringDesign(name, 8, 4));
  struct stat status {};
  ASSERT_EQ(::stat(("/dev/shm" + name).c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0600u) << "of this user alone";
  pitviper_stream s{};
  ASSERT_EQ(pitviper_stream_open(&s, name.c_str()), 0);
  EXPECT_EQ(s.header->width, 8u);
  EXPECT_STREQ(s.header->layer[1].name, "a.radiance");
  EXPECT_EQ(pitviper_stream_next(&s, 1), nullptr) << "nothing yet";
  writer.publish(numbered(20000, 8, 4));
  const pitviper_stream_frame* f = pitviper_stream_next(&s, 1000);
  ASSERT_NE(f, nullptr);
  EXPECT_EQ(static_cast<const std::uint16_t*>(pitviper_stream_pixels(&s, f, 0))[31], 16383) << "at its highest";
  EXPECT_TRUE(f->flags & PITVIPER_SATURATED);
  EXPECT_EQ(static_cast<const float*>(pitviper_stream_pixels(&s, f, 1))[31], 10000.0f);
  EXPECT_EQ(f->gain[0], 0.25);
  EXPECT_EQ(f->offset[0], -3.0);
  EXPECT_EQ(f->gain[1], 1.0);
  EXPECT_TRUE(pitviper_stream_held(&s, f));
  // Six more into four slots: those that are gone are counted.
  for (int k = 1; k <= 6; ++k) writer.publish(numbered(k, 8, 4));
  EXPECT_FALSE(pitviper_stream_held(&s, f));
  int seen = 0, last = 0;
  while ((f = pitviper_stream_next(&s, 1)) != nullptr) ++seen, last = static_cast<const std::uint16_t*>(pitviper_stream_pixels(&s, f, 0))[0];
  EXPECT_EQ(last, 6);
  EXPECT_EQ(static_cast<std::uint64_t>(seen) + s.lost, 6u);
  pitviper_stream_close(&s);
}

TEST(Ring, NoReaderTakesATornFrameForAWholeOne) {
  const std::string name = ownRing("torn");
  constexpr int kSide = 64, kFrames = 20000;
  std::atomic<std::uint64_t> held{0}, lost{0}, wrong{0};
  {
    auto writer = std::make_unique<RingWriter>(ringDesign(name, kSide, kSide));
    std::vector<std::thread> readers;
    std::atomic<int> open{0};
    for (int r = 0; r < 2; ++r)
      readers.emplace_back([&] {
        pitviper_stream s{};
        ASSERT_EQ(pitviper_stream_open(&s, name.c_str()), 0);
        ++open;
        std::uint64_t seen = 0;
        while (!s.ended) {
          const pitviper_stream_frame* f = pitviper_stream_next(&s, 1000);
          if (!f) continue;
          const auto* codes = static_cast<const std::uint16_t*>(pitviper_stream_pixels(&s, f, 0));
          const std::uint64_t sequence = f->sequence;
          const bool same = std::all_of(codes, codes + kSide * kSide, [&](std::uint16_t c) { return c == sequence % 16000; });
          ++seen;
          if (!pitviper_stream_held(&s, f)) continue;
          ++held;
          if (!same) ++wrong;
        }
        lost += s.lost;
        EXPECT_EQ(seen + s.lost, static_cast<std::uint64_t>(kFrames));
        pitviper_stream_close(&s);
      });
    while (open < 2) std::this_thread::yield();
    for (int k = 0; k < kFrames; ++k) {
      Frame f = numbered(k % 16000, kSide, kSide);
      f.stamp = FrameStamp{};
      f.stamp->sequence = static_cast<std::uint64_t>(k);
      writer->publish(f);
    }
    writer.reset();
    for (auto& r : readers) r.join();
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(held, 0u);
}

TEST(Ring, ANameHasOneWriterAndADeadOnesIsTaken) {
  const std::string name = ownRing("dead");
  {
    RingWriter writer(ringDesign(name, 8, 4));
    EXPECT_THROW(RingWriter(ringDesign(name, 8, 4)), std::runtime_error);
  }
  EXPECT_NE(::access(("/dev/shm" + name).c_str(), F_OK), 0) << "it goes with its writer";
  if (const pid_t child = fork(); child == 0) {
    new RingWriter(ringDesign(name, 8, 4));
    _exit(0);  // as if killed
  } else {
    int code = 0;
    waitpid(child, &code, 0);
  }
  EXPECT_EQ(::access(("/dev/shm" + name).c_str(), F_OK), 0);
  RingWriter next(ringDesign(name, 8, 4));
  for (const char* wrong : {"", "/", "name", "/a/b", "/a b", "/.."}) EXPECT_NE(wrongRingName(wrong), "") << wrong;
  EXPECT_EQ(wrongRingName(name), "");
}

// Rationale: a reader maps the object for reading only, but any process of the user may write to it. Expected: the writer reads nothing back: frames of a new
// reader of the same numbers come whole, wherever the header was damaged.
TEST(Ring, AHeaderWrittenByOthersChangesNothingForItsWriter) {
  const std::string name = ownRing("header");
  for (const int byte : {0x00, 0xff, 0x7f, 0x80, 0x01}) {
    RingWriter writer(ringDesign(name, 64, 48));
    pitviper_stream s{};
    ASSERT_EQ(pitviper_stream_open(&s, name.c_str()), 0);
    pitviper_stream_header whole = *s.header;
    const int file = shm_open(name.c_str(), O_RDWR, 0);
    const std::vector<unsigned char> damage(sizeof whole, static_cast<unsigned char>(byte));
    for (int k = 0; k < 9; ++k) {
      ASSERT_EQ(pwrite(file, damage.data(), damage.size(), 0), static_cast<ssize_t>(damage.size()));
      writer.publish(numbered(k, 64, 48));
    }
    EXPECT_EQ(writer.published(), 9u);
    whole.published = 9;
    ASSERT_EQ(pwrite(file, &whole, sizeof whole, 0), static_cast<ssize_t>(sizeof whole));
    s.next = 8;
    const pitviper_stream_frame* f = pitviper_stream_next(&s, 1);
    ASSERT_NE(f, nullptr);
    EXPECT_EQ(static_cast<const std::uint16_t*>(pitviper_stream_pixels(&s, f, 0))[64 * 48 - 1], 8);
    pitviper_stream_close(&s);
    close(file);
  }
}

// Expected: an object cut short, to nothing, to a part of its header or of a frame, ends its stream with a message and no process by a signal; a writer that
// never writes again goes as well. A bus error that is none of a ring's still ends a process.
TEST(Ring, AnObjectCutShortEndsItsStreamAlone) {
  for (const off_t left : {0, 100, 4096, 4096 + 5000, 5 * 4096}) {
    const std::string name = ownRing("cut");
    RingWriter writer(ringDesign(name, 64, 48)), other(ringDesign(name + ".other", 64, 48));
    for (int k = 0; k < 6; ++k) writer.publish(numbered(k, 64, 48));
    ASSERT_EQ(truncate(("/dev/shm" + name).c_str(), left), 0);
    bool told = false;
    try {
      for (int k = 0; k < 6; ++k) writer.publish(numbered(k, 64, 48));
    } catch (const std::runtime_error& e) {
      told = std::string(e.what()).find("was cut short by another process") != std::string::npos;
    }
    EXPECT_TRUE(told) << left;
    other.publish(numbered(1, 64, 48));
    RingWriter idle(ringDesign(name + ".idle", 64, 48));
    ASSERT_EQ(truncate(("/dev/shm" + name + ".idle").c_str(), 0), 0);
  }
  if (const pid_t child = fork(); child == 0) {
    const std::string name = ownRing("others");
    const int file = shm_open(name.c_str(), O_RDWR | O_CREAT | O_EXCL, 0600);
    shm_unlink(name.c_str());
    *static_cast<volatile char*>(mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0)) = 1;
    _exit(0);
  } else {
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGBUS);
  }
}

// Expected: of many processes that start at once over an object whose writer is no more, one has the name; and none takes away the name of its successor.
TEST(Ring, OneOfManyTakesAnAbandonedName) {
  const std::string name = ownRing("many");
  for (int round = 0; round < 20; ++round) {
    if (const pid_t child = fork(); child == 0) {
      new RingWriter(ringDesign(name, 8, 4));
      _exit(0);
    } else {
      waitpid(child, nullptr, 0);
    }
    int gate[2], ends[2];
    ASSERT_EQ(pipe(gate) + pipe(ends), 0);
    std::vector<pid_t> children;
    for (int k = 0; k < 6; ++k) {
      children.push_back(fork());
      if (children.back() != 0) continue;
      close(gate[1]), close(ends[1]);
      char c = 0;
      if (read(gate[0], &c, 1) != 0) _exit(9);
      try {
        RingWriter writer(ringDesign(name, 8, 4));
        writer.publish(numbered(1, 8, 4));
        if (read(ends[0], &c, 1) != 0) _exit(9);  // it lives until the others have tried
      } catch (const std::exception&) {
        _exit(1);
      }
      _exit(0);
    }
    close(gate[0]), close(ends[0]);
    close(gate[1]);
    int refused = 0;
    for (int k = 0; k < 5; ++k) {
      int status = 0;
      wait(&status);
      refused += WIFEXITED(status) && WEXITSTATUS(status) == 1;
    }
    EXPECT_EQ(refused, 5);
    struct stat status {};
    EXPECT_EQ(::stat(("/dev/shm" + name).c_str(), &status), 0) << "it has its name";
    close(ends[1]);
    int last = 0;
    wait(&last);
    EXPECT_TRUE(WIFEXITED(last) && WEXITSTATUS(last) == 0);
    EXPECT_NE(::stat(("/dev/shm" + name).c_str(), &status), 0);
  }
  // A name that was taken away by hand and given to another is the other's.
  auto first = std::make_unique<RingWriter>(ringDesign(name, 8, 4));
  shm_unlink(name.c_str());
  RingWriter second(ringDesign(name, 8, 4));
  first.reset();
  EXPECT_EQ(::access(("/dev/shm" + name).c_str(), F_OK), 0);
}

// Expected: whenever a writer is killed while its memory is made, no name and no memory stays.
TEST(Ring, AWriterKilledWhileItIsMadeLeavesNothing) {
  const std::string name = ownRing("made");
  RingDesign large = ringDesign(name, 1024, 1024);
  large.slots = 40;  // 240 MB: some tens of milliseconds
  int before = 0;
  for (const int wait_us : {0, 2000, 5000, 10000, 20000, 40000}) {
    const pid_t child = fork();
    if (child == 0) {
      try {
        new RingWriter(large);
      } catch (const std::exception&) {
        _exit(1);
      }
      for (;;) pause();
    }
    usleep(static_cast<useconds_t>(wait_us));
    const bool named = ::access(("/dev/shm" + name).c_str(), F_OK) == 0;
    before += !named;
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    if (!named) {
      EXPECT_NE(::access(("/dev/shm" + name).c_str(), F_OK), 0);
    }
    RingWriter next(ringDesign(name, 8, 4));
  }
  EXPECT_GT(before, 0);
}

TEST(QueuedSink, SkipsInRealTimeAndLosesNothingInLockstep) {
  class Slow final : public Sink {
   public:
    explicit Slow(std::atomic<int>& count) : count_(count) {}
    void take(const std::shared_ptr<const Frame>&) override {
      sleepUntil_ns(monotonic_ns() + 2000000);
      ++count_;
    }

   private:
    std::atomic<int>& count_;
  };
  for (bool skips : {true, false}) {
    std::atomic<int> count{0};
    QueuedSink sink(std::make_unique<Slow>(count), "slow", skips, 4);
    const std::int64_t from = monotonic_ns();
    for (int k = 0; k < 40; ++k) sink.take(std::make_shared<Frame>());
    const std::int64_t took = monotonic_ns() - from;
    sink.finish({});
    const SinkCounts c = sink.counts().front();
    EXPECT_EQ(c.taken, 40u);
    EXPECT_EQ(c.passedOn + c.skipped, 40u);
    EXPECT_EQ(c.passedOn, static_cast<std::uint64_t>(count));
    if (skips) {
      EXPECT_GT(c.skipped, 0u);
    } else {
      EXPECT_EQ(c.skipped, 0u);
      EXPECT_GT(took, 60000000) << "it waits for room";
    }
  }
}

// A client may stop, move or come anew while pictures wait to be sent. Expected: each picture is counted once, as sent, overtaken, cut short or without a
// client.
TEST(GigeStream, EveryPictureIsAccountedFor) {
  const int eye = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0), client = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(bind(client, reinterpret_cast<const sockaddr*>(&at), sizeof at), 0);
  socklen_t size = sizeof at;
  ASSERT_EQ(getsockname(client, reinterpret_cast<sockaddr*>(&at), &size), 0);
  for (const char* what : {"stops", "moves", "comes anew"}) {
    GigeSettings settings;
    settings.width = settings.height = 64;
    GigeTally tally;
    std::uint64_t published = 0;
    {
      GigeStream stream(eye, settings, tally, {});
      GigePlan plan;
      plan.address = INADDR_LOOPBACK;
      plan.port = ntohs(at.sin_port);
      plan.packetBytes = 576;
      plan.delay_ns = 20000000;  // a picture of 16 packets is on its way for a third of a second, and the next ones wait
      stream.configure(plan);
      stream.acquire(true);
      const auto publish = [&] {
        auto picture = std::make_shared<GigePicture>();
        picture->width = picture->height = 64;
        picture->codes.assign(64 * 64, 1);
        stream.publish(picture);
        ++published;
      };
      for (int k = 0; k < 4; ++k) publish();
      if (what == std::string("stops")) stream.acquire(false);
      if (what == std::string("moves")) ++plan.address, stream.configure(plan);
      if (what == std::string("comes anew")) stream.reopen();
      publish();
      stream.acquire(false);
      const auto counted = [&] {
        const GigeCounts c = tally.now();
        return c.pictures + c.skipped + c.cut + c.withoutConsumer;
      };
      for (int k = 0; k < 1000 && counted() < published; ++k) std::this_thread::sleep_for(std::chrono::milliseconds(10));
      EXPECT_EQ(counted(), published) << "the client " << what;
    }
  }
  close(eye), close(client);
}

TEST(ProjectorTable, IsStraightBetweenItsRows) {
  const auto file = std::filesystem::temp_directory_path() / ("pitviper_projector." + std::to_string(getpid()) + ".csv");
  const auto write = [&](const char* text) { std::ofstream(file) << text; };
  write("code [1], level [1]\n0, 10\n100, 110\n200, 255\n");
  const auto levels = readProjectorTable(file.string());
  ASSERT_EQ(levels.size(), 201u);
  EXPECT_EQ(levels[0], 10);
  EXPECT_EQ(levels[50], 60);
  EXPECT_EQ(levels[150], 183);  // 182.5
  EXPECT_EQ(levels[200], 255);
  for (const char* wrong : {"code [1], level [1]\n5, 1\n", "code [1], level [1]\n0, 1\n0, 2\n", "code [1], level [1]\n0, 1\n9, 256\n",
                            "a [1], b [1]\n0, 1\n1, 2\n", "code [1], level [1]\n0, 1\n70000, 2\n"}) {
    write(wrong);
    EXPECT_THROW(readProjectorTable(file.string()), UserError) << wrong;
  }
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace pitviper::test
