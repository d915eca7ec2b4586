#include "sim/sky/sky_places.hpp"

#include <erfa.h>
#include <erfam.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <utility>

#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

constexpr double kDegree = kPi / 180.0;
constexpr double kAu_m = ERFA_DAU;
constexpr double kSunRadius_m = 695700e3, kMoonRadius_m = 1737.4e3;
constexpr double kFirstDay = 2415020.5, kFirstUtcDay = 2436934.5, kLastDay = 2488069.5;  ///< 1900-01-01, 1960-01-01, 2100-01-01

using Vector = std::array<double, 3>;
Vector operator+(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector operator*(double f, const Vector& a) { return {f * a[0], f * a[1], f * a[2]}; }
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double length(const Vector& a) { return std::sqrt(dot(a, a)); }
Vector vectorOf(const double* a) { return {a[0], a[1], a[2]}; }

/// Place and velocity in the solar system [au, au/day], along the axes of the ICRS.
struct Path {
  Vector place{}, velocity{};
};
Path operator+(const Path& a, const Path& b) { return {a.place + b.place, a.velocity + b.velocity}; }
Path operator-(const Path& a, const Path& b) { return {a.place - b.place, a.velocity - b.velocity}; }
Path pathOf(const double (&pv)[2][3]) { return {vectorOf(pv[0]), vectorOf(pv[1])}; }
double daysOfLight(const Vector& way_au) { return ERFA_AULT / ERFA_DAYSEC * length(way_au); }

/// TT - UT1 [s], 1900 to 1961. Source: Espenak and Meeus 2006.
double deltaT_s(double year) {
  if (year < 1920.0) {
    const double t = year - 1900.0;
    return -2.79 + t * (1.494119 + t * (-0.0598939 + t * (0.0061966 - t * 0.000197)));
  }
  if (year < 1941.0) {
    const double t = year - 1920.0;
    return 21.20 + t * (0.84493 + t * (-0.076100 + t * 0.0020936));
  }
  const double t = year - 1950.0;
  return 29.07 + t * (0.407 + t * (-1.0 / 233.0 + t / 2547.0));
}

struct Clocks {
  double ut1[2], tt[2];
};

Clocks clocksAt(const Instant& when, double dut1_s) {
  Clocks c{};
  if (when.day + when.fraction < kFirstUtcDay) {
    c.ut1[0] = when.day, c.ut1[1] = when.fraction + dut1_s / ERFA_DAYSEC;
    eraUt1tt(c.ut1[0], c.ut1[1], deltaT_s(2000.0 + (when.day + when.fraction - ERFA_DJ00) / 365.25), &c.tt[0], &c.tt[1]);
    return c;
  }
  // Their warnings say that leap seconds to come are not known.
  double tai[2];
  eraUtctai(when.day, when.fraction, &tai[0], &tai[1]);
  eraTaitt(tai[0], tai[1], &c.tt[0], &c.tt[1]);
  eraUtcut1(when.day, when.fraction, dut1_s, &c.ut1[0], &c.ut1[1]);
  return c;
}

/// All that turns places in the solar system into places in one sky.
class Sky {
 public:
  Sky(const Instant& when, const GroundPlace& where, double dut1_s) : clocks_(clocksAt(when, dut1_s)) {
    const double t1 = clocks_.tt[0], t2 = clocks_.tt[1];
    double sunToEarth[2][3], earth[2][3], moon[2][3], x, y, s;
    // TT for TDB: 2 ms.
    eraEpv00(t1, t2, sunToEarth, earth);
    eraMoon98(t1, t2, moon);
    sun_ = pathOf(earth) - pathOf(sunToEarth);
    moon_ = pathOf(earth) + pathOf(moon);
    eraXys06a(t1, t2, &x, &y, &s);
    eraApco(t1, t2, earth, sunToEarth[0], x, y, s, eraEra00(clocks_.ut1[0], clocks_.ut1[1]), where.longitude_rad, where.latitude_rad, where.height_m, 0.0, 0.0,
            eraSp00(t1, t2), 0.0, 0.0, &turned_);
  }

  const Path& sun() const { return sun_; }
  const Path& moon() const { return moon_; }

  /// From here to a body, both now [au].
  Vector wayTo(const Path& body) const { return body.place - vectorOf(turned_.eb); }

  SkyPlace placeOf(const Path& body, double radius_m) {
    const Vector now = wayTo(body);
    // To where it was as what is seen of it now left it.
    Vector way = now, met, here;
    for (int i = 0; i < 2; ++i) way = now - daysOfLight(way) * body.velocity;
    way = (1.0 / length(way)) * way;
    eraAb(way.data(), turned_.v, turned_.em, turned_.bm1, met.data());
    eraRxp(turned_.bpn, met.data(), here.data());
    double ra, dec;
    eraC2s(here.data(), &ra, &dec);
    return placeOf(ra, dec, length(now) * kAu_m, radius_m);
  }

  SkyPlace placeOf(const Star& star) {
    double ra, dec;
    eraAtciq(star.rightAscension_rad, star.declination_rad, star.eastMotion_radPerYear / std::cos(star.declination_rad), star.northMotion_radPerYear, 0.0, 0.0,
             &turned_, &ra, &dec);
    return placeOf(ra, dec, 0.0, 0.0);
  }

  /// Right ascension and declination of the moon's pole and its turn about it, `late` days ago [rad].
  Vector moonTurn(double late) const {
    const double d = (clocks_.tt[0] - ERFA_DJ00) + clocks_.tt[1] - late;
    struct Wave {
      double phase, rate, ra, dec, turn;
    };
    static constexpr Wave waves[] = {
        {125.045, -0.0529921, -3.8787, 1.5419, 3.5610}, {250.089, -0.1059842, -0.1204, 0.0239, 0.1208}, {260.008, 13.0120009, 0.0700, -0.0278, -0.0642},
        {176.625, 13.3407154, -0.0172, 0.0068, 0.0158}, {357.529, 0.9856003, 0.0, 0.0, 0.0252},         {311.589, 26.4057084, 0.0072, -0.0029, -0.0066},
        {134.963, 13.0649930, 0.0, 0.0009, -0.0047},    {276.617, 0.3287146, 0.0, 0.0, -0.0046},        {34.226, 1.7484877, 0.0, 0.0, 0.0028},
        {15.134, -0.1589763, -0.0052, 0.0008, 0.0052},  {119.743, 0.0036096, 0.0, 0.0, 0.0040},         {239.961, 0.1643573, 0.0, 0.0, 0.0019},
        {25.053, 12.9590088, 0.0043, -0.0009, -0.0044}};
    Vector sum{269.9949 + 0.0031 * d / 36525.0, 66.5392 + 0.0130 * d / 36525.0, 38.3213 + 13.17635815 * d - 1.4e-12 * d * d};
    for (const Wave& w : waves) {
      const double e = (w.phase + w.rate * d) * kDegree;
      sum = sum + Vector{w.ra * std::sin(e), w.dec * std::cos(e), w.turn * std::sin(e)};
    }
    return kDegree * sum;
  }

 private:
  SkyPlace placeOf(double ra, double dec, double distance_m, double radius_m) {
    double azimuth, zenith, hour, declination, right;
    eraAtioq(ra, dec, &turned_, &azimuth, &zenith, &hour, &declination, &right);
    return {eraAnp(azimuth), kPi / 2.0 - zenith, distance_m, distance_m > radius_m ? std::asin(radius_m / distance_m) : 0.0};
  }

  Clocks clocks_;
  Path sun_, moon_;
  eraASTROM turned_{};
};

/// East, north, up.
Vector towards(const SkyPlace& p) {
  return {std::cos(p.elevation_rad) * std::sin(p.azimuth_rad), std::cos(p.elevation_rad) * std::cos(p.azimuth_rad), std::sin(p.elevation_rad)};
}

/// At one place on the sky, the direction of another: from the zenith's to the left.
double angleAt(const SkyPlace& at, const SkyPlace& other) {
  const double sinA = std::sin(at.azimuth_rad), cosA = std::cos(at.azimuth_rad), sinE = std::sin(at.elevation_rad);
  const Vector up{-sinE * sinA, -sinE * cosA, std::cos(at.elevation_rad)}, left{-cosA, sinA, 0.0};
  const Vector way = towards(other);
  return std::atan2(dot(way, left), dot(way, up));
}

// ROLO's bands: wavelength [um], a0 to a3, b1 to b3, d1 to d3. Kieffer and Stone 2005, table 4.
struct Band {
  double wavelength;
  std::array<double, 4> a;
  std::array<double, 3> b, d;
};
constexpr Band kBands[] = {
    {0.3500, {-2.67511, -1.78539, 0.50612, -0.25578}, {0.03744, 0.00981, -0.00322}, {0.34185, 0.01441, -0.01602}},
    {0.3551, {-2.71924, -1.74298, 0.44523, -0.23315}, {0.03492, 0.01142, -0.00383}, {0.33875, 0.01612, -0.00996}},
    {0.4050, {-2.35754, -1.72134, 0.40337, -0.21105}, {0.03505, 0.01043, -0.00341}, {0.35235, -0.03818, -0.00006}},
    {0.4123, {-2.34185, -1.74337, 0.42156, -0.21512}, {0.03141, 0.01364, -0.00472}, {0.36591, -0.05902, 0.00080}},
    {0.4144, {-2.43367, -1.72184, 0.43600, -0.22675}, {0.03474, 0.01188, -0.00422}, {0.35558, -0.03247, -0.00503}},
    {0.4416, {-2.31964, -1.72114, 0.37286, -0.19304}, {0.03736, 0.01545, -0.00559}, {0.37935, -0.09562, 0.00970}},
    {0.4658, {-2.35085, -1.66538, 0.41802, -0.22541}, {0.04274, 0.01127, -0.00439}, {0.33450, -0.02546, -0.00484}},
    {0.4750, {-2.28999, -1.63180, 0.36193, -0.20381}, {0.04007, 0.01216, -0.00437}, {0.33024, -0.03131, 0.00222}},
    {0.4869, {-2.23351, -1.68573, 0.37632, -0.19877}, {0.03881, 0.01566, -0.00555}, {0.36590, -0.08945, 0.00678}},
    {0.5440, {-2.13864, -1.60613, 0.27886, -0.16426}, {0.03833, 0.01189, -0.00390}, {0.37190, -0.10629, 0.01428}},
    {0.5491, {-2.10782, -1.66736, 0.41697, -0.22026}, {0.03451, 0.01452, -0.00517}, {0.36814, -0.09815, 0.00000}},
    {0.5538, {-2.12504, -1.65970, 0.38409, -0.20655}, {0.04052, 0.01009, -0.00388}, {0.37206, -0.10745, 0.00347}},
    {0.6651, {-1.88914, -1.58096, 0.30477, -0.17908}, {0.04415, 0.00983, -0.00389}, {0.37141, -0.13514, 0.01248}},
    {0.6931, {-1.89410, -1.58509, 0.28080, -0.16427}, {0.04429, 0.00914, -0.00351}, {0.39109, -0.17048, 0.01754}},
    {0.7036, {-1.92103, -1.60151, 0.36924, -0.20567}, {0.04494, 0.00987, -0.00386}, {0.37155, -0.13989, 0.00412}},
    {0.7453, {-1.86896, -1.57522, 0.33712, -0.19415}, {0.03967, 0.01318, -0.00464}, {0.36888, -0.14828, 0.00958}},
    {0.7637, {-1.85258, -1.47181, 0.14377, -0.11589}, {0.04435, 0.02000, -0.00738}, {0.39126, -0.16957, 0.03053}},
    {0.7748, {-1.80271, -1.59357, 0.36351, -0.20326}, {0.04710, 0.01196, -0.00476}, {0.36908, -0.16182, 0.00830}},
    {0.8653, {-1.74561, -1.58482, 0.35009, -0.19569}, {0.04142, 0.01612, -0.00550}, {0.39200, -0.18837, 0.00978}},
    {0.8726, {-1.76779, -1.60345, 0.37974, -0.20625}, {0.04645, 0.01170, -0.00424}, {0.39354, -0.19360, 0.00568}},
    {0.8820, {-1.73011, -1.61156, 0.36115, -0.19576}, {0.04847, 0.01065, -0.00404}, {0.40714, -0.21499, 0.01146}},
    {0.9284, {-1.75981, -1.45395, 0.13780, -0.11254}, {0.05000, 0.01476, -0.00513}, {0.41900, -0.19963, 0.02940}},
    {0.9393, {-1.76245, -1.49892, 0.07956, -0.07546}, {0.05461, 0.01355, -0.00464}, {0.47936, -0.29463, 0.04706}},
    {0.9421, {-1.66473, -1.61875, 0.14630, -0.09216}, {0.04533, 0.03010, -0.01166}, {0.57275, -0.38204, 0.04902}},
    {1.0595, {-1.59323, -1.71358, 0.50599, -0.25178}, {0.04906, 0.03178, -0.01138}, {0.48160, -0.29486, 0.00116}},
    {1.2432, {-1.53594, -1.55214, 0.31479, -0.18178}, {0.03965, 0.03009, -0.01123}, {0.49040, -0.30970, 0.01237}},
    {1.5387, {-1.33802, -1.46208, 0.15784, -0.11712}, {0.04674, 0.01471, -0.00656}, {0.53831, -0.38432, 0.03473}},
    {1.6336, {-1.34567, -1.46057, 0.23813, -0.15494}, {0.03883, 0.02280, -0.00877}, {0.54393, -0.37182, 0.01845}},
    {1.9815, {-1.26203, -1.25138, -0.06569, -0.04005}, {0.04157, 0.02036, -0.00772}, {0.49099, -0.36092, 0.04707}},
    {2.1263, {-1.18946, -2.55069, 2.10026, -0.87285}, {0.03819, -0.00685, -0.00200}, {0.29239, -0.34784, -0.13444}},
    {2.2509, {-1.04232, -1.46809, 0.43817, -0.24632}, {0.04893, 0.00617, -0.00259}, {0.38154, -0.28937, -0.01110}},
    {2.3836, {-1.08403, -1.31032, 0.20323, -0.15863}, {0.05955, -0.00940, 0.00083}, {0.36134, -0.28408, 0.01010}},
};

/// Angles: g and Phi in radians in the powers, g in degrees beside p; theta and phi, latitude and longitude of the place, in degrees.
double reflectanceIn(const Band& k, const MoonLook& moon) {
  constexpr double kLast = 97.0 * kDegree;
  const double g = std::min(moon.phaseAngle_rad, kLast), gDegrees = g / kDegree, sun = std::clamp(moon.sunLongitude_rad, -kLast, kLast);
  const double theta = moon.placeLatitude_rad / kDegree, phi = moon.placeLongitude_rad / kDegree;
  double ln = k.a[0] + g * (k.a[1] + g * (k.a[2] + g * k.a[3]));
  ln += sun * (k.b[0] + sun * sun * (k.b[1] + sun * sun * k.b[2]));
  ln += 0.00034115 * theta - 0.0013425 * phi + sun * (0.00095906 * theta + 0.00066229 * phi);
  ln += k.d[0] * std::exp(-gDegrees / 4.06054) + k.d[1] * std::exp(-gDegrees / 12.8802) + k.d[2] * std::cos((gDegrees + 30.5858) / 16.7498);
  const auto dimmed = [](double degrees) { return 0.026 * degrees + 4e-9 * std::pow(degrees, 4.0); };
  return std::exp(ln) * std::pow(10.0, -0.4 * (dimmed(moon.phaseAngle_rad / kDegree) - dimmed(gDegrees)));
}

/// Reads text from the front.
class Front {
 public:
  explicit Front(std::string_view text) : rest_(text) {}
  bool atEnd() const { return rest_.empty(); }
  bool take(std::string_view any) {
    if (rest_.empty() || any.find(rest_.front()) == std::string_view::npos) return false;
    rest_.remove_prefix(1);
    return true;
  }
  std::optional<int> digits(std::size_t count) {
    if (rest_.size() < count || rest_.substr(0, count).find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
    int value = 0;
    std::from_chars(rest_.data(), rest_.data() + count, value);
    rest_.remove_prefix(count);
    return value;
  }
  /// What digits behind a point are worth; nothing where there is none.
  std::optional<double> fraction() {
    double value = 0.0, unit = 1.0;
    const std::size_t before = rest_.size();
    while (auto d = digits(1)) value += *d * (unit /= 10.0);
    if (rest_.size() == before) return std::nullopt;
    return value;
  }

 private:
  std::string_view rest_;
};

std::string twoDigits(int n) { return (n < 10 ? "0" : "") + std::to_string(n); }

}  // namespace

bool isCovered(const Instant& when) {
  const double whole = when.day + when.fraction;
  return whole >= kFirstDay && whole <= kLastDay;
}

std::optional<Instant> parseInstant(std::string_view text, std::string& problem) {
  const auto refuse = [&](const std::string& why) -> std::optional<Instant> {
    problem = why;
    return std::nullopt;
  };
  const std::string form = "a date and time such as 2026-06-21T12:30:00Z or 2026-06-21T14:30+02:00";
  Front front(text);
  const auto year = front.digits(4);
  if (!year || !front.take("-")) return refuse(form);
  const auto month = front.digits(2);
  if (!month || !front.take("-")) return refuse(form);
  const auto day = front.digits(2);
  if (!day || !front.take("Tt ")) return refuse(form);
  const auto hour = front.digits(2);
  if (!hour || !front.take(":")) return refuse(form);
  const auto minute = front.digits(2);
  if (!minute) return refuse(form);
  double second = 0.0;
  if (front.take(":")) {
    const auto whole = front.digits(2);
    if (!whole) return refuse(form);
    second = *whole;
    if (front.take(".,")) {
      const auto part = front.fraction();
      if (!part) return refuse("digits behind the point of its seconds");
      second += *part;
    }
  }
  int offset_min = 0;
  if (!front.take("Zz")) {
    const bool east = front.take("+");
    if (east || front.take("-")) {
      const auto hours = front.digits(2);
      const bool colon = front.take(":");
      const auto minutes = colon || !front.atEnd() ? front.digits(2) : std::optional<int>(0);
      if (!hours || !minutes || *hours > 23 || *minutes > 59) return refuse("an offset from UTC such as +02:00 or -07:00, or Z, behind its time");
      offset_min = (east ? 1 : -1) * (*hours * 60 + *minutes);
    }
  }
  if (!front.atEnd()) return refuse(form);

  namespace chrono = std::chrono;
  const chrono::year_month yearMonth{chrono::year(*year), chrono::month(static_cast<unsigned>(*month))};
  if (!yearMonth.ok()) return refuse("a month of 01 to 12");
  const chrono::year_month_day date = yearMonth / chrono::day(static_cast<unsigned>(*day));
  if (!date.ok()) {
    const auto last = static_cast<unsigned>((yearMonth / chrono::last).day());
    return refuse("a day of 01 to " + std::to_string(last) + " in month " + twoDigits(*month) + " of " + std::to_string(*year));
  }
  if (*hour > 23 || *minute > 59) return refuse("a time of 00:00 to 23:59");
  const auto minutes = chrono::sys_days(date) + chrono::minutes(*hour * 60 + *minute - offset_min);
  const auto utcDay = chrono::floor<chrono::days>(minutes);
  const chrono::year_month_day utc(utcDay);
  const int rest = static_cast<int>((minutes - utcDay).count());
  // ERFA's UTC begins in 1960; with none before, it would make the last day of 1959 longer.
  const bool hasUtc = utc.year() >= chrono::year(1960);
  Instant instant;
  const int state = eraDtf2d(hasUtc ? "UTC" : "UT1", static_cast<int>(utc.year()), static_cast<int>(static_cast<unsigned>(utc.month())),
                             static_cast<int>(static_cast<unsigned>(utc.day())), rest / 60, rest % 60, second, &instant.day, &instant.fraction);
  // 1: leap seconds to come are not known.
  if (state != 0 && state != 1) return refuse("seconds below 60: UTC has no leap second there");
  if (!isCovered(instant)) return refuse("a date of 1900-01-01T00:00Z to 2100-01-01T00:00Z: where earth and moon are is known for these alone");
  return instant;
}

SkyPlace sunPlace(const Instant& when, const GroundPlace& where, double dut1_s) {
  Sky sky(when, where, dut1_s);
  return sky.placeOf(sky.sun(), kSunRadius_m);
}

MoonLook moonLook(const Instant& when, const GroundPlace& where, double dut1_s) {
  Sky sky(when, where, dut1_s);
  MoonLook look;
  look.place = sky.placeOf(sky.moon(), kMoonRadius_m);
  // On the moon, which goes with earth, light from here comes straight, and the sun's 20" ahead.
  const Vector toPlace = -1.0 * sky.wayTo(sky.moon());
  const Path sun = sky.sun() - sky.moon();
  Vector toSun = sun.place - daysOfLight(sun.place) * sun.velocity, here = toPlace, across;
  eraPxp(toSun.data(), here.data(), across.data());
  look.phaseAngle_rad = std::atan2(length(across), dot(toSun, toPlace));
  look.litFraction = (1.0 + std::cos(look.phaseAngle_rad)) / 2.0;
  look.brightLimb_rad = angleAt(look.place, sky.placeOf(sky.sun(), kSunRadius_m));
  look.sunDistance_m = length(sun.place) * kAu_m;

  const Vector turn = sky.moonTurn(daysOfLight(toPlace));
  double axes[3][3];
  eraIr(axes);
  eraRz(kPi / 2.0 + turn[0], axes);
  eraRx(kPi / 2.0 - turn[1], axes);
  eraRz(turn[2], axes);
  Path pole = sky.moon();
  pole.place = pole.place + (kMoonRadius_m / kAu_m) * vectorOf(axes[2]);
  look.northPole_rad = angleAt(look.place, sky.placeOf(pole, 0.0));
  const auto selenographic = [&](const Vector& to, double& latitude, double& longitude) {
    const Vector body{dot(vectorOf(axes[0]), to), dot(vectorOf(axes[1]), to), dot(vectorOf(axes[2]), to)};
    latitude = std::atan2(body[2], std::hypot(body[0], body[1]));
    longitude = std::atan2(body[1], body[0]);
  };
  selenographic(toPlace, look.placeLatitude_rad, look.placeLongitude_rad);
  selenographic(toSun, look.sunLatitude_rad, look.sunLongitude_rad);
  return look;
}

double moonReflectance(const MoonLook& moon, double wavelength_um) {
  const auto above = std::ranges::upper_bound(kBands, wavelength_um, {}, &Band::wavelength);
  if (above == std::begin(kBands)) return reflectanceIn(*above, moon);
  const auto below = above - 1;
  const double low = reflectanceIn(*below, moon);
  if (above == std::end(kBands)) return low;
  return std::lerp(low, reflectanceIn(*above, moon), (wavelength_um - below->wavelength) / (above->wavelength - below->wavelength));
}

double moonlightShare(const MoonLook& moon, double wavelength_um) {
  // A disc's solid angle by (r / d)^2, as ROLO's own 6.4177e-5 sr at 384400 km.
  const double size = kMoonRadius_m / moon.place.distance_m, near = kAu_m / moon.sunDistance_m;
  return moonReflectance(moon, wavelength_um) * size * size * near * near;
}

Twilight twilightAt(double sunElevation_rad) {
  if (sunElevation_rad >= -50.0 / 60.0 * kDegree) return Twilight::Day;
  if (sunElevation_rad >= -6.0 * kDegree) return Twilight::Civil;
  if (sunElevation_rad >= -12.0 * kDegree) return Twilight::Nautical;
  return sunElevation_rad >= -18.0 * kDegree ? Twilight::Astronomical : Twilight::Night;
}

std::string_view nameOf(Twilight twilight) {
  switch (twilight) {
    case Twilight::Day:
      return "day";
    case Twilight::Civil:
      return "civil twilight";
    case Twilight::Nautical:
      return "nautical twilight";
    case Twilight::Astronomical:
      return "astronomical twilight";
    case Twilight::Night:
      break;
  }
  return "night";
}

std::optional<std::vector<Star>> readStars(std::string_view csv, std::string& problem) {
  constexpr double mas = kDegree / 3.6e6;
  const auto cut = [](std::string_view& rest, char at) {
    const std::size_t end = std::min(rest.find(at), rest.size());
    const std::string_view part = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    return part;
  };
  std::vector<Star> stars;
  bool headed = false;
  for (int number = 1; !csv.empty(); ++number) {
    std::string_view line = cut(csv, '\n');
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty() || line.front() == '#' || !std::exchange(headed, true)) continue;
    bool good = std::ranges::count(line, ',') == 7;
    const auto value = [&] {
      const std::string_view part = cut(line, ',');
      double v = 0.0;
      const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), v);
      good = good && error == std::errc() && end == part.data() + part.size() && std::isfinite(v);
      return v;
    };
    Star star;
    star.name = cut(line, ',');
    star.rightAscension_rad = value() * kDegree, star.declination_rad = value() * kDegree;
    star.eastMotion_radPerYear = value() * mas, star.northMotion_radPerYear = value() * mas;
    star.magnitude = value(), star.colour = value();
    if (!line.empty()) star.infraredMagnitude = value();
    if (!good || star.name.empty() || std::abs(star.declination_rad) >= kPi / 2.0) {
      problem = "line " + std::to_string(number) +
                ": expected a name, right ascension and declination in degrees, motions to east and north in mas per year, V, B-V, and K or nothing";
      return std::nullopt;
    }
    stars.push_back(std::move(star));
  }
  return stars;
}

std::vector<SkyPlace> starPlaces(std::span<const Star> stars, const Instant& when, const GroundPlace& where, double dut1_s) {
  Sky sky(when, where, dut1_s);
  std::vector<SkyPlace> places;
  places.reserve(stars.size());
  for (const Star& star : stars) places.push_back(sky.placeOf(star));
  return places;
}

double starTemperature_K(double colour) { return 4600.0 * (1.0 / (0.92 * colour + 1.7) + 1.0 / (0.92 * colour + 0.62)); }

double starIrradiance(const Star& star, double wavelength_um) {
  constexpr double kV_um = 0.545, kVZero = 3.631e-8, kK_um = 2.19, kKZero = 3.961e-10;
  const double c = kSecondRadiation_umK / starTemperature_K(star.colour);
  const auto blackBody = [&](double um) {
    return kVZero * std::pow(10.0, -0.4 * star.magnitude) * std::pow(kV_um / um, 5.0) * std::expm1(c / kV_um) / std::expm1(c / um);
  };
  if (!star.infraredMagnitude) return blackBody(wavelength_um);
  const double power = std::log(kKZero * std::pow(10.0, -0.4 * *star.infraredMagnitude) / blackBody(kK_um)) / std::log(kK_um / kV_um);
  return blackBody(wavelength_um) * std::pow(std::clamp(wavelength_um, kV_um, kK_um) / kV_um, power);
}

}  // namespace pitviper
