#pragma once
// CIGI 3.3, host to image generator: one datagram's bytes as packets. No sockets, no exceptions, nothing of a scene.
// Source: Interface Control Document for the Common Image Generator Interface, version 3.3 (Boeing, TST08I016, 2008), chapter 4; the places of
// all fields are held against Wireshark's dissector. Angles are in degrees here as on the wire; cigi_commands.hpp turns them into ours.
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace pitviper {

/// What a host may ask for, and what a Start of Frame says (Maintenance: the latter only).
enum class CigiMode { Standby = 0, Operate = 1, Debug = 2, Maintenance = 3 };
enum class CigiEntityState { Standby = 0, Active = 1, Destroyed = 2 };
enum class CigiClamp { None = 0, NonConformal = 1, Conformal = 2 };
enum class CigiTrackMode { Off = 0, ForceCorrelate = 1, Scene = 2, Target = 3, Ship = 4, Own5 = 5, Own6 = 6, Own7 = 7 };
enum class CigiDegree { None = 0, X = 1, Y = 2, Z = 3, Yaw = 4, Pitch = 5, Roll = 6 };
enum class CigiMirror { None = 0, Horizontal = 1, Vertical = 2, Both = 3 };
enum class CigiComponentClass {
  Entity = 0,
  View = 1,
  ViewGroup = 2,
  Sensor = 3,
  RegionalSea = 4,
  RegionalTerrain = 5,
  RegionalWeather = 6,
  GlobalSea = 7,
  GlobalTerrain = 8,
  GlobalWeather = 9,
  Atmosphere = 10,
  CelestialSphere = 11,
  Event = 12,
  System = 13,
  SymbolSurface = 14,
  Symbol = 15
};

/// IG Control (1), first in each datagram.
struct CigiIgControl {
  std::endian byteOrder = std::endian::little;  ///< of the whole datagram
  int minorVersion = 3;
  int databaseNumber = 0;  ///< -128 to 127; above 0: load that one; 0: go on with what is loaded
  CigiMode mode = CigiMode::Standby;
  bool timestampValid = false, extrapolate = false;
  std::uint32_t hostFrame = 0, timestamp_10us = 0;
  std::uint32_t lastIgFrame = 0;  ///< the number of the newest Start of Frame that the host has
};

/// Entity Control (2).
struct CigiEntityControl {
  int entity = 0, type = 0, parent = 0;  ///< the parent's only where attached
  CigiEntityState state = CigiEntityState::Standby;
  bool attached = false, collisions = false, inheritAlpha = false, extrapolate = false;
  CigiClamp clamp = CigiClamp::None;
  int alpha = 255;  ///< 0: invisible
  double roll_deg = 0.0, pitch_deg = 0.0, yaw_deg = 0.0;
  /// Latitude, longitude [deg] and height above the ellipsoid [m]; where attached, x forward, y right, z down in the parent's axes [m].
  std::array<double, 3> position{};
};

/// Component Control (4) and Short Component Control (5): the latter has two words.
struct CigiComponentControl {
  CigiComponentClass componentClass = CigiComponentClass::Entity;
  int component = 0, instance = 0, state = 0;
  int wordCount = 6;
  std::array<std::uint32_t, 6> words{};  ///< in our byte order, each as a whole; 0 beyond their count
};

/// Offsets [m] and angles [deg] that a host has enabled; what is not stays as it was, and its bytes are not looked at.
struct CigiDegreesGiven {
  std::optional<double> x_m, y_m, z_m, roll_deg, pitch_deg, yaw_deg;
};

/// Articulated Part Control (6).
struct CigiPartControl {
  int entity = 0, part = 0;
  bool enabled = false;
  CigiDegreesGiven given;
};

/// Short Articulated Part Control (7): one degree of freedom of each of two parts, which may be the same.
struct CigiShortPartControl {
  struct Single {
    int part = 0;
    bool enabled = false;
    CigiDegree degree = CigiDegree::None;
    double value = 0.0;  ///< m or deg
  };
  int entity = 0;
  std::array<Single, 2> parts;
};

/// Rate Control (8).
struct CigiRateControl {
  int entity = 0, part = 0;
  bool ofPart = false;
  bool ownAxes = false;                   ///< else those of the world or the parent
  std::array<double, 3> linear_m_s{};     ///< x, y, z
  std::array<double, 3> angular_deg_s{};  ///< roll, pitch, yaw
};

/// View Control (16).
struct CigiViewControl {
  int view = 0;   ///< not looked at where there is a group
  int group = 0;  ///< 0: one view
  int entity = 0;
  CigiDegreesGiven given;
};

/// Sensor Control (17).
struct CigiSensorControl {
  int view = 0, sensor = 0;
  bool on = false, blackHot = false, lineDropout = false, automaticGain = false, trackBlack = false, extendedResponse = false;
  CigiTrackMode trackMode = CigiTrackMode::Off;
  double gain = 0.0, level = 0.0, noise = 0.0;  ///< 0 to 1
  double acCoupling_us = 0.0;
};

/// View Definition (21). Half-angles are enabled one by one; left and bottom are below zero of a view that looks ahead.
struct CigiViewDefinitionPacket {
  int view = 0, group = 0, viewType = 0, pixelReplication = 0;
  CigiMirror mirror = CigiMirror::None;
  bool orthographic = false, toTop = false;
  std::optional<double> near_m, far_m, left_deg, right_deg, top_deg, bottom_deg;
};

using CigiPacket = std::variant<CigiEntityControl, CigiComponentControl, CigiPartControl, CigiShortPartControl, CigiRateControl, CigiViewControl,
                                CigiSensorControl, CigiViewDefinitionPacket>;

/// Why a datagram is refused.
enum class CigiFault {
  None,
  TooShort,         ///< less than an IG Control
  NotIgControl,     ///< the first packet is another
  WrongVersion,     ///< not 3.2 or 3.3
  NoByteOrder,      ///< the magic number is neither 0x8000 nor 0x0080
  ZeroSize,         ///< a packet says that it has no bytes
  OddSize,          ///< of a packet: no multiple of 8 bytes
  WrongSize,        ///< not that of its kind
  BeyondEnd,        ///< a packet goes on beyond the datagram
  SecondIgControl,  ///< there is one to a datagram
  OutOfRange,       ///< a number that is none, or outside of what its field holds
  TooManyPackets
};

/// One datagram. With a fault there are no packets: a frame is taken as a whole or not at all.
struct CigiMessage {
  std::optional<CigiIgControl> control;  ///< also with a fault of a later packet: a host that waits is to get its answer
  std::vector<CigiPacket> packets;       ///< in their order
  int notServed = 0;                     ///< packets of other kinds: skipped
  CigiFault fault = CigiFault::None;
  std::string words;  ///< of a fault: which packet, at which byte, what is wrong; one line of printable characters
};

/// More than a datagram of UDP (65507 bytes) holds of the smallest packets that are served (16 bytes).
constexpr int kMostCigiPackets = 4096;

/// Reads a datagram. It takes any bytes: a fault tells what is wrong. Both byte orders, versions 3.2 and 3.3 (the packets above are the same).
CigiMessage readCigi(std::span<const std::byte> datagram);

}  // namespace pitviper
