// Figures of smokes. Scattering was worked out by the Mie series (C. F. Bohren, D. R. Huffman, Absorption and Scattering of Light by Small Particles (1983),
// ch. 4 and app. A, whose test case came out with its five digits) for spheres whose diameters are log-normal by number.
#include "materials/fields/smoke_types.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {
namespace {

// Wavelength [um], extinction [m2/kg], albedo, asymmetry.
constexpr SmokeOptics kMtv[] = {{0.3, 3.84e+03, 0.821, 0.664}, {0.35, 3.71e+03, 0.841, 0.671}, {0.4, 3.49e+03, 0.852, 0.675}, {0.47, 3.13e+03, 0.86, 0.674},
                                {0.55, 2.7e+03, 0.861, 0.666}, {0.63, 2.3e+03, 0.858, 0.654},  {0.7, 1.99e+03, 0.852, 0.641}, {0.8, 1.62e+03, 0.841, 0.621},
                                {0.9, 1.32e+03, 0.826, 0.598}, {1.06, 963, 0.798, 0.561},      {1.3, 625, 0.746, 0.502},      {1.6, 391, 0.67, 0.432},
                                {2, 235, 0.56, 0.347},         {2.5, 144, 0.428, 0.261},       {3, 101, 0.316, 0.193},        {3.5, 76.6, 0.231, 0.144},
                                {4, 62, 0.168, 0.111},         {4.5, 52.3, 0.123, 0.0876},     {5, 45.4, 0.0913, 0.0709},     {6, 36.3, 0.0517, 0.0491},
                                {7, 30.4, 0.0305, 0.0358},     {8, 26.3, 0.0183, 0.0271},      {9, 23.2, 0.011, 0.0211},      {10, 20.8, 0.00805, 0.0171},
                                {11, 18.9, 0.00607, 0.0142},   {12, 17.3, 0.00468, 0.0119},    {13, 15.9, 0.00369, 0.0102},   {14, 14.8, 0.00296, 0.00876},
                                {16, 12.9, 0.00198, 0.00671},  {20, 10.3, 0.00102, 0},         {25, 8.25, 0.000521, 0},       {30, 6.88, 0.000302, 0}};

constexpr SmokeOptics kSoot[] = {
    {0.3, 2.55e+04, 0.46, 0.6},     {0.35, 1.92e+04, 0.385, 0.6},    {0.4, 1.53e+04, 0.324, 0.6},    {0.47, 1.18e+04, 0.258, 0.6},
    {0.55, 9.4e+03, 0.202, 0.6},    {0.63, 7.81e+03, 0.162, 0.524},  {0.7, 6.81e+03, 0.135, 0.471},  {0.8, 5.77e+03, 0.107, 0.412},
    {0.9, 5.02e+03, 0.0864, 0.367}, {1.06, 4.16e+03, 0.0638, 0.311}, {1.3, 3.32e+03, 0.0434, 0.254}, {1.6, 2.66e+03, 0.0291, 0.206},
    {2, 2.1e+03, 0.0188, 0.165},    {2.5, 1.67e+03, 0.0121, 0.132},  {3, 1.39e+03, 0.00844, 0.11},   {3.5, 1.19e+03, 0.00622, 0.0943},
    {4, 1.04e+03, 0.00477, 0.0825}, {4.5, 920, 0.00377, 0.0733},     {5, 828, 0.00306, 0.066},       {6, 689, 0.00212, 0.055},
    {7, 590, 0.00156, 0.0471},      {8, 516, 0.0012, 0.0413},        {9, 459, 0.000945, 0.0367},     {10, 413, 0.000766, 0.033},
    {11, 375, 0.000633, 0.03},      {12, 344, 0.000532, 0.0275},     {13, 317, 0.000453, 0.0254},    {14, 295, 0.000391, 0.0236},
    {16, 258, 0.000299, 0.0206},    {20, 206, 0.000192, 0.0165},     {25, 165, 0.000123, 0.0132},    {30, 138, 8.51e-05, 0.011}};

constexpr SmokeOptics kAlumina[] = {{0.3, 639, 1, 0.634},
                                    {0.35, 661, 1, 0.612},
                                    {0.4, 668, 1, 0.615},
                                    {0.47, 687, 1, 0.597},
                                    {0.55, 713, 1, 0.58},
                                    {0.63, 739, 1, 0.564},
                                    {0.7, 748, 1, 0.564},
                                    {0.8, 778, 1, 0.556},
                                    {0.9, 802, 1, 0.555},
                                    {1.06, 819, 1, 0.553},
                                    {1.3, 803, 1, 0.557},
                                    {1.6, 759, 1, 0.556},
                                    {2, 667, 1, 0.556},
                                    {2.5, 534, 1, 0.553},
                                    {3, 412, 1, 0.548},
                                    {3.5, 314, 1, 0.539},
                                    {4, 236, 1, 0.528},
                                    {4.5, 175, 1, 0.515},
                                    {5, 128, 1, 0.5},
                                    {6, 64.5, 0.999, 0.46},
                                    {7, 29.1, 0.988, 0.407},
                                    {8, 10.9, 0.902, 0.342},
                                    {9, 3.17, 0.188, 0.261},
                                    {10, 5.76, 0.0738, 0.222},
                                    {11, 17, 0.0184, 0.19},
                                    {11.7, 46.1, 0.00549, 0.171},
                                    {12.15, 135, 0.00165, 0.16},
                                    {12.64, 3.03e+03, 6.42e-05, 0.15},
                                    {13.15, 1.75e+03, 9.69e-05, 0.139},
                                    {13.67, 197, 0.000751, 0.13},
                                    {14.22, 57.2, 0.00225, 0.121},
                                    {15.4, 23.2, 0.00418, 0.104},
                                    {16, 64.2, 0.00131, 0.0971},
                                    {18, 10.2, 0.00535, 0.0777},
                                    {20, 67.8, 0.000545, 0.0635},
                                    {21, 109, 0.000283, 0.0578},
                                    {22, 6.18, 0.00417, 0.0528},
                                    {25, 3.81, 0.00415, 0.0412},
                                    {30, 0.5, 0.0156, 0.0288}};

constexpr SmokeOptics kWhitePhosphorus[] = {
    {0.3, 5.5e+03, 0.99, 0.754},    {0.4, 4.9e+03, 0.99, 0.762}, {0.55, 4.08e+03, 0.99, 0.745}, {0.7, 3e+03, 0.99, 0.713}, {0.9, 1.9e+03, 0.985, 0.661},
    {1.06, 1.37e+03, 0.975, 0.615}, {1.3, 870, 0.95, 0.543},     {1.6, 520, 0.88, 0.457},       {2, 330, 0.7, 0.357},      {2.5, 270, 0.43, 0.262},
    {2.9, 340, 0.2, 0.206},         {3.5, 300, 0.12, 0.146},     {4, 280, 0.08, 0.113},         {4.5, 280, 0.05, 0.0905},  {5, 260, 0.037, 0.0737},
    {6, 290, 0.016, 0.0516},        {7, 230, 0.011, 0.0381},     {8, 320, 0.005, 0.0293},       {9, 480, 0.002, 0.0232},   {9.6, 520, 0.001, 0.0204},
    {10.2, 480, 0.001, 0.0181},     {11, 330, 0.001, 0.0156},    {12, 220, 0.001, 0.0131},      {13, 190, 0.001, 0.0112},  {14, 180, 0.001, 0.00965},
    {20, 200, 0, 0.00474},          {30, 150, 0, 0.00211}};

constexpr SmokeOptics kFogOil[] = {{0.3, 6.2e+03, 0.999, 0.68},  {0.4, 6.9e+03, 0.999, 0.699},   {0.55, 7e+03, 0.999, 0.72},    {0.7, 6.3e+03, 0.999, 0.721},
                                   {0.9, 4.6e+03, 0.998, 0.703}, {1.06, 3.48e+03, 0.998, 0.682}, {1.3, 2.45e+03, 0.995, 0.643}, {1.6, 1.6e+03, 0.99, 0.589},
                                   {2, 950, 0.985, 0.514},       {2.5, 520, 0.97, 0.423},        {3, 300, 0.85, 0.344},         {3.2, 300, 0.8, 0.316},
                                   {3.35, 700, 0.33, 0.297},     {3.42, 800, 0.27, 0.289},       {3.55, 500, 0.38, 0.273},      {3.7, 200, 0.8, 0.257},
                                   {4, 150, 0.8, 0.227},         {4.5, 100, 0.78, 0.184},        {5, 75, 0.7, 0.152},           {6, 55, 0.48, 0.107},
                                   {6.7, 60, 0.3, 0.0863},       {6.85, 150, 0.11, 0.0826},      {7, 60, 0.26, 0.0792},         {8, 30, 0.3, 0.061},
                                   {9, 24, 0.24, 0.0484},        {10, 22, 0.17, 0.0393},         {11, 20, 0.13, 0.0326},        {12, 18, 0.1, 0.0274},
                                   {13.9, 25, 0.04, 0.0205},     {20, 15, 0.01, 0.00993},        {30, 10, 0, 0.00442}};

const SmokeType kTypes[] = {
    {"white_phosphorus", "white screening smoke: droplets of phosphoric acid; the mass is that of the droplets in air of some 50 % humidity",
     "Extinction: mean figures of EOSAEL's COMBIC, 4080 m2/kg at 0.4-0.7 um, 1370 at 1.06 um, 290 at 3-5 um, 380 at 8-12 um (D. W. Hoock, R. A. Sutherland, "
     "Obscuration "
     "Countermeasures, in The Infrared and Electro-Optical Systems Handbook vol. 7 (1993), ch. 6), met within 5 %; spectra between these with the phosphate "
     "band at 9 to 10 um "
     "are ours; field tests scatter by a factor of 1.5. Albedo, asymmetry: droplets of 0.35 um median diameter, geometric deviation 1.5, n 1.42, 1.5 g/cm3, "
     "which have 4400 and "
     "1420 m2/kg at 0.55 and 1.06 um",
     kWhitePhosphorus},
    {"fog_oil", "white screening smoke: droplets of oil; thin in the infrared",
     "Extinction: mean figures of EOSAEL's COMBIC, 6850 m2/kg at 0.4-0.7 um, 3480 at 1.06 um, 250 at 3-5 um, 20 at 8-12 um (Hoock and Sutherland 1993, as "
     "above), met within "
     "10 %; places of the bands of C-H at 3.4 and 6.8 um as of any mineral oil. Albedo, asymmetry: droplets of 0.5 um median diameter, geometric deviation "
     "1.5, n 1.48, 0.88 g/cm3, "
     "which have 7300 and 4200 m2/kg at 0.55 and 1.06 um",
     kFogOil},
    {"mtv", "white-grey smoke of magnesium and Teflon: magnesium fluoride and oxide with some carbon",
     "Products: E.-C. Koch, Metal-Fluorocarbon Based Energetic Materials (2012). Chosen: 95 % of the mass clear spheres of 0.25 um median diameter, "
     "geometric deviation 1.6, "
     "n between MgF2 (M. J. Dodge, Appl. Opt. 23, 1980 (1984)) and MgO, 3.3 g/cm3; 5 % soot of 7.5 m2/g at 0.55 um (T. C. Bond, R. W. Bergstrom, Aerosol Sci. "
     "Technol. 40, 27 "
     "(2006)) as 1/wavelength. Lattice bands beyond 14 um left out. Nobody has published it measured in flight: a factor of 2",
     kMtv},
    {"alumina", "smoke of aluminised rocket motors, cold; water and hydrochloric acid that condense on it in humid air left out",
     "Chosen: spheres of 0.6 um median diameter, geometric deviation 1.8 (mass mean 1.7 um; R. W. Hermsen, J. Spacecraft 18 (1981) 483 has 1 to 10 um by "
     "motor), n of sapphire "
     "(I. H. Malitson, M. J. Dodge 1972) up to 8 um, 3.97 g/cm3; absorption as of the library's alumina at 300 K (materials/library/gases/alumina.csv)",
     kAlumina},
    {"soot", "black smoke of diesel and oil fires",
     "Absorption 7.5 m2/g at 0.55 um as 1/wavelength (T. C. Bond, R. W. Bergstrom, Aerosol Sci. Technol. 40, 27 (2006)), albedo 0.2 there (the same; 0.15 to "
     "0.3) with scattering as "
     "1/wavelength^3, asymmetry 0.6 falling as 1/wavelength: chosen for aggregates of some 0.2 um; extinction at 0.63 um is 7.8 against 8.7 m2/g measured of "
     "many fuels "
     "(G. W. Mulholland, C. Croarkin, Fire Mater. 24 (2000) 227)",
     kSoot}};

}  // namespace

std::span<const SmokeType> smokeTypes() { return kTypes; }

const SmokeType* findSmokeType(std::string_view name) {
  const auto found = std::find_if(std::begin(kTypes), std::end(kTypes), [&](const SmokeType& t) { return t.name == name; });
  return found == std::end(kTypes) ? nullptr : &*found;
}

Medium smokeGas(const SmokeType& type) {
  const auto made = [&](auto value) {
    Spectrum::Table t;
    for (const SmokeOptics& o : type.optics) {
      t.wavelength_um.push_back(o.wavelength_um);
      t.value.push_back(value(o));
    }
    t.name = "smoke " + std::string(type.name);
    return t;
  };
  // Extinction falls by powers of the wavelength: straight lines of logarithms, told by straight lines a tenth of an octave long (0.2 % for a fourth power).
  const Spectrum::Table coarse = made([](const SmokeOptics& o) { return o.extinction_m2_kg; });
  Spectrum::Table fine;
  fine.name = coarse.name;
  for (std::size_t k = 0; k + 1 < coarse.value.size(); ++k) {
    const double from = std::log(coarse.wavelength_um[k]), to = std::log(coarse.wavelength_um[k + 1]);
    const double low = std::log(coarse.value[k]), high = std::log(coarse.value[k + 1]);
    const int parts = std::max(1, static_cast<int>(std::ceil((to - from) / (0.1 * std::log(2.0)))));
    for (int j = 0; j < parts; ++j) {
      fine.wavelength_um.push_back(j == 0 ? coarse.wavelength_um[k] : std::exp(from + (to - from) * j / parts));
      fine.value.push_back(std::exp(low + (high - low) * j / parts));
    }
  }
  fine.wavelength_um.push_back(coarse.wavelength_um.back());
  fine.value.push_back(coarse.value.back());
  Medium gas;
  gas.absorption_per_m = Spectrum(std::move(fine));
  gas.albedo = Spectrum(made([](const SmokeOptics& o) { return o.albedo; }));
  gas.asymmetry = Spectrum(made([](const SmokeOptics& o) { return o.asymmetry; }));
  return gas;
}

}  // namespace pitviper
