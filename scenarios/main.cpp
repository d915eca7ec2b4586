// The pitviper program: finds the command, turns errors into one line and an exit code.
#include <cstdio>
#include <exception>
#include <map>
#include <new>

#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/process.hpp"
#include "sim/frame/version.hpp"
#include "sim/gl/context.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/table.hpp"

namespace {

using namespace pitviper;

struct Command {
  int (*run)(const Arguments&);
  const char* summary;
  const char* help;
};

const std::map<std::string, Command>& commands() {
  static const std::map<std::string, Command> all = {
      {"run",
       {runCommand, "render a scenario to calibrated EXR frames",
        "pitviper run SCENARIO.yaml [--out FOLDER] [--frames A:B] [--set path.to.key=value]... [--root FOLDER]... [--preview]\n             [--video FILE.mp4] [--sheet] [--report] [--scale run|frame|LOW:HIGH] [--palette NAME] [--plain] [--truth]\n             [--preview-range "
        "LAYER=LOW:HIGH]... [--overwrite] [--timing]\n\n"
        "Renders the scenario's frames: one EXR per camera and frame in FOLDER (default 'out'), named <camera>_<frame>.exr,\n"
        "with a float layer <channel>.<quantity> per output, truth.* layers and a grey picture for programs that know nothing of layers; other formats by\n"
        "'sinks: [{sink: files, format: tiff}]'; probes write <probe>.csv; a camera with 'spectral_image:'\n"
        "also writes <camera>_<frame>_spectral.exr for pitviper integrate.\n\n"
        "  --out FOLDER     where to write; created if missing\n"
        "  --frames A:B     frames A to B only, both included (or one: A); counted from 0: --frames 0:9 draws ten\n"
        "  --set PATH=VALUE replaces or adds a value: --set cameras.0.samples=2, --set cameras.seeker.exposure='1 ms',\n"
        "                   --set entities.jet.temperature='300 K'; list items by number or by their name; repeatable;\n"
        "                   --set parameters.speed='300 m/s' a parameter of the scenario\n"
        "  --root FOLDER    a folder, besides the scenario's own, from which it may include and extend files; repeatable\n"
        "  --plan FILE      draws a camera with the plan of another run of this scenario, FOLDER/CAMERA.plan: the same scenario and plan give the same bytes;\n"
        "                   with --set accuracy=reference the reference of that run, along its lines; of anything else's it is refused; repeatable\n"
        "  --poses FILE     CAMERA_poses.csv, as a run with a gimbal leaves it: the camera looks where that says, frame by frame; repeatable\n"
        "  --preview        also a PNG per frame: every channel with colour bar and unit\n"
        "  --video FILE.mp4 also a film of the previews (of several cameras one each, FILE_<camera>.mp4); by ffmpeg\n"
        "  --sheet          also <camera>_sheet.png: up to twenty pictures of the first layer, evenly over the run\n"
        "  --report         also report.html: scenario, plans, sensors, sheet, what its layers and targets do over time, notes; all in one file\n"
        "  --scale WHICH    of colour bars. frame: each picture its own (previews unless given); run: one for all, drawn when the run ends (films and sheets\n"
        "                   unless given); LOW:HIGH: these ends, in the layers' unit\n"
        "  --palette NAME   thermal, white_hot, black_hot; auto: white_hot below 0.9 um, else thermal\n"
        "  --plain          pixels alone, one to one: no bar, no words\n"
        "  --truth          truth layers too\n"
        "  --preview-range LAYER=LOW:HIGH  ends of a layer's colour bar, in its unit (implies --preview); repeatable. Without it the bar\n"
        "                   runs from the 0.5 to the 99.8 percentile, and is bent where a few bright things would hide the rest\n\n"
        "  --overwrite      also replaces files of other scenarios, and files that are not of this program\n"
        "  --timing         says at the end how long planning, tables, programs and the first frame took, and where the time of frames after it went: visibility, shadows, air,\n"
        "                   shading, readback, files; drawing then "
        "waits for each\n"
        "                   part, which makes it somewhat slower\n\n"
        "Files of the same names are replaced where they are of the same scenario (its text, what it extends and includes, --set); another's is refused before\n"
        "anything is drawn. Other files in FOLDER are left as they are. Any number of runs of one scenario may write one FOLDER at once.\n"
        "On a terminal a bar shows how far it is; elsewhere lines come on stderr, the first after 3 s, each next after as long again as all before.\n"
        "The last lines sum up: frames, time, frames a second, and for each camera what its plan expects to be off by at most.\n"}},
      {"audit",
       {auditCommand, "hold a scenario's pictures against the reference, pixel by pixel: is what was asked for kept?",
        "pitviper audit SCENARIO.yaml [--frames A:B] [--camera NAME]... [--out FOLDER] [--set path.to.key=value]... [--root FOLDER]...\n\n"
        "Draws frames (the first, the middle and the last) of each camera as run does, by its plan, and again by the reference: every wavelength, in double\n"
        "precision, along the same lines (subpixels, views of small bodies and of bright parts). Prints what each layer's pixels are off by,\n"
        "|L - Lref| / max(Lref, 1e-3 x the 99th percentile of Lref), beside what was asked and predicted, and where the worst is. The reference takes seconds\n"
        "to minutes a frame: --set cameras.seeker.film.width=64 and so on makes it quicker. Exit code 4 where a pixel is farther off than was asked.\n"
        "The same by hand: run, then run --set accuracy=reference --plan FOLDER/CAMERA.plan draws the reference along that run's lines, to another --out.\n"
        "A reference without that plan looks along its own lines (all subpixels, 256 across a small body): outlines and small bodies then differ.\n\n"
        "  --frames A:B     these frames, both included; of an exposure with motion its middle\n"
        "  --camera NAME    this camera alone; repeatable\n"
        "  --out FOLDER     also audit.csv and CAMERA_audit.png, a picture of the errors; created if missing\n"
        "  --set, --root    as of run\n"}},
      {"check",
       {checkCommand, "validate a scenario, render nothing",
        "pitviper check SCENARIO.yaml [--set path.to.key=value]... [--root FOLDER]... [--plan] [--audit]\n\nReads everything the scenario names and reports the first mistake as "
        "file:line:col with "
        "the fix (exit code 2).\nThen tells what each camera sees in the first, the middle and the last frame: a line a body (many alike in one) with its "
        "size,\n"
        "range, size in pixels, and whether it is out of view, behind the camera, hidden by another or smaller than a pixel; 'hidden' is\n"
        "found by rays to a few dozen places on the body. Meshes whose size smells of another unit than the one given are noted.\n\n"
        "  --root FOLDER    as of run\n"
        "  --plan           also plans each camera, which takes seconds, and says how many wavelengths it takes; the plan is kept, as of run\n"
        "  --audit          also draws those frames, works 16 pixels of each (or as many as the scenario's 'audit' says) out by the reference,\n"
        "                   and tells how far they are from it; writes nothing\n"}},
      {"plan",
       {planCommand, "what a scenario's accuracy makes of it: terms, wavelengths, predicted error",
        "pitviper plan SCENARIO.yaml [--set path.to.key=value]... [--root FOLDER]... [--json] [--speed] [--shaders]\n\n"
        "Per camera and probe: how much of a pixel each term can be in each channel, which are kept and which dropped; into how many\n"
        "groups of wavelengths each channel's integral goes, of how many the reference has, and the error predicted for lines of sight the\n"
        "groups were not fitted to. 'accuracy: 1 %' in the scenario, or --set accuracy='0.1 %', asks for another. Plans are kept by content in\n"
        "$XDG_CACHE_HOME/pitviper (or ~/.cache/pitviper).\n\n"
        "  --root FOLDER  as of run\n"
        "  --json     for programs: a list with an object per camera and probe\n"
        "  --speed    also predicted frames a second, from a measured yardstick\n"
        "  --shaders  also the text of the shading program\n"}},
      {"info",
       {infoCommand, "what is in a frame, or what this machine draws with",
        "pitviper info [FILE.exr [--at COLUMN,ROW [--terms SCENARIO.yaml [--set path.to.key=value]... [--root FOLDER]...]]]\n\nLayers with unit, minimum, mean and maximum, and "
        "all attributes. Without a file: the driver, its "
        "limits, and the way\n"
        "in which transparent things are blended (fetch, barrier or ping_pong; PITVIPER_BLEND chooses another).\n\n"
        "  --at COLUMN,ROW  the values of one pixel with their units; (0,0) is the top left\n"
        "  --terms SCENARIO.yaml  what that pixel is made of: emission, each light's reflection, the dome's, the air's emission, scattered sunlight,\n"
        "                   media and lamps in view, by the body that sends it, worked out in double precision at every wavelength; the scenario must be\n"
        "                   the one that the frame was drawn from, with the same --set and --root, and its tables and meshes as they were\n"}},
      {"integrate",
       {integrateCommand, "apply another sensor to a spectral image",
        "pitviper integrate FILE_spectral.exr SENSOR.yaml [--out FILE.exr] [--preview]\n\n"
        "Integrates a spectral image (a camera's 'spectral_image:') over the channels of a sensor file, such as scenarios/sensors/mw_insb.yaml:\n"
        "the same keys 'channels', 'optics', 'exposure' and 'aperture' as of a camera; what it leaves out is as of the camera. Writes an EXR with a layer\n"
        "<channel>.<quantity> per output. The sensor meets each bin's mean radiance: exact where its response is flat over the bin; how far off\n"
        "the others are, to first order, is printed per layer and kept as attribute binning_error.<layer> (median and maximum over pixels).\n\n"
        "  --out FILE.exr   what to write; otherwise <image>_<sensor>.exr beside the image\n"
        "  --preview        also a PNG: every channel with colour bar and unit\n\n"
        "The bins must cover every channel: one that reaches beyond them is refused.\n"}},
      {"bench",
       {benchCommand, "speed of this machine beside a fixed yardstick",
        "pitviper bench [--factor NAME] [--frames N] [--out FOLDER]\n"
        "pitviper bench --scenario SCENARIO.yaml [--frames N] [--set path.to.key=value]... [--root FOLDER]...\npitviper bench --accuracy SCENARIO.yaml [--size N] [--frames N] "
        "[--set "
        "path.to.key=value]... [--root FOLDER]... [--out FOLDER]\n"
        "pitviper bench --first [SCENARIO.yaml]... [--states A,B,...] [--frames N] [--seconds S] [--set path.to.key=value]... [--root FOLDER]... [--out FOLDER]\n"
        "pitviper bench --guard FILE.csv [--quick] [--strict]\n\n"
        "Times direct and buffered mode on a wall that fills the film (256x256, 16 channels, 16 wavelengths, one light, thermal emission, air\n"
        "on both legs), then with one factor varied at a time, in rounds that alternate with a bare loop over 16 wavelengths, the yardstick.\n"
        "Prints tables: milliseconds, million pixels and frames a second, speed by the yardstick, time by the centre. Takes some minutes.\n\n"
        "  --factor NAME        this factor only: centre, overdraw, channels, wavelengths, lights, film, bodies, triangles, layers,\n"
        "                       shading, blend\n"
        "  --frames N           frames to time in each row, 10 or more (default 60; fewer of slow ones)\n"
        "  --out FOLDER         also write bench.csv and a chart, bench.png (needs VTK), in FOLDER; created if missing\n"
        "\nWith --phong: tables of 200 entries of spectral Phong lobes against the formula, error and time, as in the paper that proposed them.\n"
        "\nWith --scenario: time of a frame of each camera, the frames in their order, drawing and readback, no files (with a gimbal its sensor and tracker too); beside them the yardstick, and where "
        "the time of a frame goes,\n"
        "part by part: what updates tables and shadow maps, what is seen, shading, readback and so on.\n"
        "\nWith --accuracy: the scenario's first camera at accuracies of 10 to 0.1 %, at 4 to 340 even samples and at 16 Gauss points a channel, against\n"
        "the reference (double precision on the CPU, every wavelength; slow). Prints frames a second and the error of each channel's pixels,\n"
        "|L - Lref| / max(Lref, 1e-3 x the 99th percentile of Lref), and as a temperature difference. The error is that of spectral sampling, tables,\n"
        "dropped terms and single precision; what a pixel sees is the same on both sides.\n\n"
        "  --size N             columns of the film, its field of view kept\n"
        "  --frames N           frames, spread over the scenario's time (default 3)\n"
        "  --set path=value     as of run, such as --set cameras.seeker.samples=1\n"
        "  --root FOLDER        as of run\n"
        "  --out FOLDER         also write accuracy.csv and a chart, accuracy.png (needs VTK)\n"
        "\nWith --first: how long one waits for a picture. Each scenario (without one: all that are shipped) from nothing cached, a second time, and after each of six changes, with what the\n"
        "first two have cached: a body 10 K warmer, another visibility, field of view, position, material, half the accuracy's error. A process of its own for each state, and a cache of their\n"
        "own. A change that a scenario cannot have is left out, and said. Prints seconds by the clock and processor seconds of reading, planning, tables (all other preparing), programs\n"
        "(made, lines, and files that the driver's cache gained: 0 where it compiled nothing) and the first frame of every camera; percentiles of the frames after it, drawn and read back one\n"
        "after the other, from the first again where the scenario has fewer (not with a gimbal); memory. Spectral images, probes, audits and files are left out.\n\n"
        "  --states A,B         these alone, besides 'first': second, temperature, visibility, field_of_view, position, material, accuracy\n"
        "  --frames N           after the first, at most (default 100)\n"
        "  --seconds S          that they may take in each state (default 20): fewer of slow ones\n"
        "  --set, --root        as of run\n"
        "  --out FOLDER         also write first.csv, a line a state, with all figures\n"
        "  bench --once SCENARIO.yaml [--frames N] [--seconds S] [--set path=value]... [--root FOLDER]... is one such state by itself, with what is cached now, a figure a line\n"
        "\nWith --guard: measures again the figures that FILE holds (tests/bench_guard.csv says how it is written) and names each that grew, or shrank, by more than a fifth. Seconds are told as where the\n"
        "yardstick gives 6 million pixels a second, so that machines compare. Exit code 0 whatever grew.\n\n"
        "  --quick              the set 'quick' alone: under a minute\n"
        "  --strict             exit code 1 where a figure grew by more than a fifth\n"}},
      {"atmosphere",
       {atmosphereCommand, "what air there is in the library, in a MODTRAN tape7 or in a CSV file, as tables and charts",
        "pitviper atmosphere [NAME|FILE] [--range KM] [--out FOLDER]\n\n"
        "Without an argument: the library airs. NAME: one of them (clear_mls), or an air table (us76_rural), as FILE.air: mean transmittance and\n"
        "radiance of level and slant paths, sky, sun at the ground.\n"
        "FILE.csv: air by tables; the columns it may have are listed at the head of atmosphere/tabulated_csv.hpp, for instance\n"
        "  wavelength_um, range_km, transmittance, path_radiance_W/(m2 sr um)\n"
        "FILE: a tape7 (.tp7) of MODTRAN, transmittance, thermal radiance with or without the sun or solar irradiance, any number of runs; prints\n"
        "for each: kind, model, path, wavelengths and step, mean transmittance in 3-5 and 8-12 um where covered; and how it serves as air along a path.\n\n"
        "  --range KM       of the only path in a tape7 whose cards have none\n"
        "  --out FOLDER     also NAME.csv, FILE_run<N>.csv or FILE_air.csv, every column over wavelength in W/(m2 sr um) or W/(m2 um), and a chart of\n"
        "                   the same name (PNG, needs VTK), in FOLDER; created if missing\n"}},
      {"material",
       {materialCommand, "what a surface or a substance of the library, or of a file, is: tables, charts, a sphere of it",
        "pitviper material [NAME|FILE] [--out FOLDER] [--axis UNIT] [--unit %|1] [--quantity WHAT] [--column N] [--wavelengths FILE]\n\n"
        "Without an argument: the library's materials and substances. NAME: one of them; FILE.yaml: a material of your own (what stands below its name\n"
        "under 'materials:'). Prints reflectance, emissivity and transmittance by wavelength and view angle.\n"
        "FILE of others: refractiveindex.info's YAML, or a spectrum in columns (ECOSTRESS, the USGS's libraries 6 and 7, field and Fourier spectrometers' text,\n"
        "JCAMP-DX): prints it as a substance or a material, to be kept in a file of its own, and says on the standard error what it changed or took for\n"
        "granted. What the words above a spectrum's numbers leave open is refused; these say it, and count before those words:\n\n"
        "  --axis UNIT      of the wavelengths: um, nm, angstrom, 1/cm (wavenumbers) or eV (photon energies)\n"
        "  --unit %|1       of the values: per cent, or shares of 1\n"
        "  --quantity WHAT  reflectance, transmittance, or emissivity (of an opaque surface: 1 - reflectance)\n"
        "  --column N       the column of the values, counted from 1\n"
        "  --wavelengths FILE  the wavelengths of a file with one column, as the USGS's library 7 keeps them\n"
        "  --out FOLDER     also NAME.png, charts of spectra, emissivity by angle and reflection of light from 45 degrees (needs VTK), and\n"
        "                   NAME_sphere.png, a sphere of it under a sun and a dome of daylight as an eye sees it (of materials without data there:\n"
        "                   at 320 K in the infrared), in FOLDER; created if missing\n"}},
      {"measure",
       {measureCommand, "a camera on a lab bench: SiTF, NETD, noise, MTF, gain, well, point response from its pictures, beside its design",
        "pitviper measure NAME|CAMERA.yaml [--frames N] [--film N] [--set key=value]... [--out FOLDER]\n"
        "                 [--ranges SCENARIO.yaml [--target WxH] [--contrast 'T K'] [--false-alarms N] [--root FOLDER]...]\n\n"
        "Draws flat fields, levels from dark to full, a slanted edge (ISO 12233), a point in a pixel's middle, edge and corner, and four-bar targets through a\n"
        "camera of the library, or one in a file with a key 'camera', whose channels have 'output: counts'; and measures from these pictures alone: SiTF, NETD, the\n"
        "seven components of three-dimensional noise with their standard errors, gain by photon transfer, full well, linearity, MTF, a pixel's share of a star, the\n"
        "bars' contrast, what a star is to send for its signal to be its noise, and the MRTD over frequency (FLIR92 with an eye's own threshold). Flat fields are at 300 K, or\n"
        "where the detector is half full if 300 K give it next to nothing.\n\n"
        "  --frames N       of each flat field (default 64)\n"
        "  --film N         a side of the square in the film's middle that is measured (default 128)\n"
        "  --set key=value  a key of the camera: --set exposure='2 ms'\n"
        "  --ranges FILE    also how far a target is detected, recognised and identified through this scenario's air, along the line of sight of its first camera: by\n"
        "                   Johnson's cycles (STANAG 4347: 1, 3 and 6) and by TTP (V50 2, 7.5 and 13); and as a spot: its TNR, and how far a threshold finds it\n"
        "  --target WxH     metres (default 2.3x2.3, STANAG 4347)\n"
        "  --contrast 'T K' of the target over what is around it, which is as hot as the flat fields (default 2 K)\n"
        "  --false-alarms N an hour, over the film, of the threshold for spots (default 1)\n"
        "  --root FOLDER    as of run\n"
        "  --out FOLDER     also NAME.html, a page with charts (needs VTK), NAME.csv and the charts; created if missing\n"}},
      {"stream", {streamCommand, "frames at a fixed rate to hardware and other programs, and commands from them", 
        "pitviper stream SCENARIO.yaml [--clock CLOCK] [--rate 'R Hz'] [--frames N | --duration 'T s' | --endless] [--late WHAT] [--delay 'D ms'] [--hold]\n"
        "                [--shared-memory /NAME] [--gige ADDRESS] [--gstreamer PIPELINE]... [--projector DISPLAY]... [--commands PLACE] [--cigi PLACE]\n"
        "                [--out FOLDER] [--set path.to.key=value]... [--root FOLDER]... [--plan CAMERA.plan]... [--poses CAMERA_poses.csv]... [pictures as of run]\n"
        "pitviper stream --self-test [--rate 'R Hz'] [--duration 'T s']\n"
        "\n"
        "Frames of every camera at a fixed rate to other programs and to hardware, and commands from them. Plans and programs are made before the first frame. Without a way\n"
        "for frames (here, or in the scenario's 'sinks') they go to shared memory /pitviper. Ends after the scenario's frames, or as asked; SIGINT and SIGTERM end it after the frame it\n"
        "is at. Prints at the end what became of every frame, and its times; exit code 3 if one is unaccounted for.\n"
        "\n"
        "Clock\n"
        "  --clock real-time    tick n begins n periods after the first, by the machine's monotonic clock (default)\n"
        "  --clock lockstep     simulated time moves when a host says so, by --commands or --cigi; frames are those of run, bit for bit\n"
        "  --clock free         as fast as it goes\n"
        "  --clock trigger      each pulse is a tick: a software trigger of --gige, or {\"pulse\": true} by --commands\n"
        "  --clock vsync        each picture that the first --projector shows is a tick\n"
        "  --rate 'R Hz'        in place of the scenario's 'time.rate'\n"
        "  --frames N, --duration 'T s', --endless\n"
        "                       in place of the scenario's 'time.frames'; lockstep has no end unless given one\n"
        "  --delay 'D ms'       a frame is due so long after its tick began (default: a period)\n"
        "  --hold               and leaves then, not before: constant delay\n"
        "  --late send          what is not there when it is due is sent as soon as it is (default) ...\n"
        "  --late drop          ... is not sent ...\n"
        "  --late repeat        ... or the picture before is sent in its place. A tick that could not be begun within a period (or the delay less one) is dropped, or repeated\n"
        "  --fifo P, --cores LIST\n"
        "                       SCHED_FIFO priority, 1 to 99, and cores of the thread that draws, where the system lets it\n"
        "  'accuracy: {asked: 1 %, at_most: 3 %}' in the scenario: where the rate does not hold it draws coarser, up to that; frames say to what\n"
        "\n"
        "Frames to\n"
        "  --shared-memory /NAME  POSIX shared memory, of this user alone; sim/stream/ring/pitviper_stream.h says what is in it and is the reader in C\n"
        "  --gige ADDRESS       each camera as a machine-vision camera, compatible with GVCP/GVSP, tested with Aravis, at this IPv4 address of the machine and those after it;\n"
        "                       clients set exposure and gain, and trigger. More of it: 'sink: gige' in the scenario\n"
        "  --gstreamer PIPELINE a pipeline of the first camera (again: of the next) after 'appsrc', GRAY16_LE, as for gst-launch-1.0: 'videoconvert ! autovideosink'\n"
        "  --projector DISPLAY  of the first camera (again: the next): 'window', or the number of a monitor that it fills; 16 bits, the high byte in red and the low one in green\n"
        "  --projector-table FILE.csv\n"
        "                       instead grey of 8 bits by a table that was measured: columns 'code [1], level [1]'\n"
        "  and --preview, --sheet, --video and so on as of run, and the scenario's sinks: what is slow has a queue, and skips frames in real time\n"
        "\n"
        "Commands from (on this machine alone unless an address is given; what is malformed, stale or impossible is counted, ignored and told once a kind)\n"
        "  --commands PLACE     lines of JSON at a TCP port (7380, 0.0.0.0:7380) or a Unix socket (/tmp/pitviper.sock), with the words of a scenario's 'commands':\n"
        "                       {\"command\": \"move\", \"entity\": \"jet\", \"position\": [\"0 m\", \"1 km\", \"500 m\"]}, look, temperature, light, trigger, gain; with \"at\" for a time; \"id\" asks for an\n"
        "                       answer; \"host_frame\" comes back with the frame. {\"step\": 1} in lockstep, {\"run\": false} stops and {\"run\": true} starts real time, {\"follow\": true} asks\n"
        "                       for a line a frame, {\"status\": true}, {\"pulse\": true}, {\"end\": true}\n"
        "  --stale 'T s'        commands for a time so long ago are not carried out (default 1 s); younger ones are taken on to the frame's time\n"
        "  --cigi PLACE         CIGI 3.3 at a UDP port (8004, 0.0.0.0:8004), Start of Frame back; IG mode standby stops, operate starts; in lockstep each IG Control is a step.\n"
        "                       What has which number: scenarios/README.md\n"
        "  scenarios/clients has a tracker, readers and a CIGI host\n"
        "\n"
        "  --out FOLDER         stream.json and stream.html, with a chart; created if missing\n"
        "  --root FOLDER        as of run\n"
        "  --self-test          what each way takes on this machine, without drawing: 640x512 pixels at 60 Hz for 5 s each, in a table\n"}},
      {"keys", {keysCommand, "the reference of every scenario key (Markdown)", "pitviper keys\n\nPrints the key reference as in scenarios/README.md.\n"}},
  };
  return all;
}

void printHelp() {
  std::printf("pitviper: infrared and optronic sensor scenes in calibrated units\n\nusage: pitviper COMMAND ...\n\n");
  for (const auto& [name, c] : commands()) std::printf("  %-10s %s\n", name.c_str(), c.summary);
  std::printf("  %-10s %s\n", "test", "build and run every test (the pitviper script)");
  std::printf("  %-10s %s\n", "figures", "write the figures in the documents anew (the pitviper script)");
  std::printf("\npitviper COMMAND --help tells more. Exit codes: 0 done, 1 the machine could not, 2 a mistake in the input, 3 frames of a stream unaccounted for, 4 an audit found more than was asked, 130 and 143 ended by a signal.\n");
}

int run(Arguments arguments) {
  if (arguments.empty() || arguments[0] == "--help" || arguments[0] == "-h" || (arguments[0] == "help" && arguments.size() == 1)) {
    printHelp();
    return arguments.empty() ? 2 : 0;
  }
  if (arguments[0] == "--version") {
    std::printf("pitviper %s\n", kVersion);
    return 0;
  }
  if (arguments[0] == "help" && arguments.size() > 1) arguments = {arguments[1], "--help"};
  const std::string name = arguments[0];
  arguments.erase(arguments.begin());
  const auto found = commands().find(name);
  if (found == commands().end()) {
    std::vector<std::string> names;
    for (const auto& [n, c] : commands()) names.push_back(n);
    throw UserError({"pitviper", 0, 0, -1}, "unknown command '" + name + "'", "one of those of pitviper --help",
                    didYouMean(name, names, "see pitviper --help"));
  }
  for (const auto& a : arguments)
    if (a == "--help" || a == "-h") {
      std::fputs(found->second.help, stdout);
      return 0;
    }
  return found->second.run(arguments);
}

}  // namespace

int main(int argc, char** argv) {
  prepareProcess();
  int code = 0;
  try {
    code = run({argv + 1, argv + argc});
  } catch (const UserError& e) {
    std::fflush(stdout);
    tell(e.what());
    code = 2;
  } catch (const std::bad_alloc&) {
    std::fflush(stdout);
    code = tellOutOfMemory();
  } catch (const std::exception& e) {
    std::fflush(stdout);
    tell((std::string("pitviper: ") + e.what()).c_str());
    code = 1;
  }
  return finishOutput(code);
}
