#pragma once
// What a scenario declares, as plain structs with defaults, in SI units and the patient's frame: origin at
// the umbilicus, +x patient left, +y cephalad, +z out of the abdomen. Defaults carry their source: (c)
// clinical literature, (d) a design value of ours, uncalibrated. A new key is a member here and a row in
// scene_keys.cpp: reading, checking and what is generated for authors follow.

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/status.h"
#include "geometry/swept.h"
#include "geometry/types.h"

namespace calot {

inline constexpr double abdomen_reach = 500e-3;  ///< m, of anything in an abdomen from the umbilicus

struct SphereShape {
  double radius = 20e-3;  ///< m
  bool operator==(const SphereShape&) const = default;
};

struct PearShape {
  double length = 80e-3;  ///< m; 70 to 100 mm (c)
  double width = 35e-3;   ///< m; 30 to 40 mm (c)
  /// Vertices are closer by `refine` (>= 1) within `refine_radius` (m) of the fundus, where the grasper
  /// works.
  double refine = 1.0, refine_radius = 20e-3;
  bool operator==(const PearShape&) const = default;
};

/// A hollow organ along a curved axis with a radius at each of its stations, from its neck to its fundus: a gallbladder
/// with its pouch. The stations lie in the patient's frame and are the organ's neck and fundus.
struct SweptShape {
  std::vector<SweptStation> along;
  bool operator==(const SweptShape&) const = default;
};

/// Whose axes a mesh file's coordinates are along: the organ's (organ_frame.h), or the scene's.
enum class MeshAxes { organ, scene };
constexpr MeshAxes last_of(MeshAxes) { return MeshAxes::scene; }

struct MeshFile {
  std::string path;
  double scale = 1.0;  ///< coordinates of the file times this are metres
  /// These are turned about this axis by its length, rad, moved by the offset, m, and are then along these axes.
  Vec3 turn = Vec3::Zero(), offset = Vec3::Zero();
  MeshAxes axes = MeshAxes::organ;
  /// The wall passes through the file's points; else they are control points, and the wall is smaller where it bulges.
  bool through_points = false;
  bool operator==(const MeshFile&) const = default;
};

/// Which end of a tube that is divided stays with the patient: the one that is held, itself or by what it is tied to (its
/// end where both are, or neither), or always the same.
enum class PatientEnd { held, start, end };
constexpr PatientEnd last_of(PatientEnd) { return PatientEnd::end; }

/// What flows in a tube; by it a duct and an artery look different.
enum class Carries { bile, blood };
constexpr Carries last_of(Carries) { return Carries::blood; }

/// A duct or a vessel: a tube along a line; a solid thread where its wall is as thick as its radius.
struct TubeShape {
  std::vector<Vec3> points;  ///< m, of its middle at rest, from its start to its end
  double radius = 2.5e-3;    ///< m, outer; a common duct has 2 to 3 mm (c)
  double end_radius = 0;     ///< m, at its end; 0: as at its start
  int nodes = 11;            ///< control nodes of the middle line
  double pressure = 0;       ///< Pa, gauge, of what it carries
  PatientEnd patient_end = PatientEnd::held;
  Carries carries = Carries::bile;
  /// What drives it out of an end that is cut open where the patient feeds it, Pa, gauge, and what resists on the way
  /// there, whoever feeds it, Pa s/m^3. None: as what it carries and its width have it, feed_of() (liquid/leak_source.h).
  std::optional<double> feed_pressure = {}, feed_resistance = {};
  /// m, outer, one at each of its points and straight in between, by the way along them; empty: from `radius` to
  /// `end_radius`. Other bodies, but not instruments, feel a tube everywhere as thick as where it is thickest.
  std::vector<double> radii = {};
  double start_radius() const { return radii.empty() ? radius : radii.front(); }
  bool operator==(const TubeShape&) const = default;
};

/// A rigid thing, or one that strains alike everywhere: a box with round edges, a ball where it has no size, a ring, or a
/// closed surface from a file.
struct RigidShape {
  Vec3 size = Vec3::Zero();    ///< m, edges of the box without its rounding, along x, y and z
  double rounding = 5e-3;      ///< m, radius of the edges, of the ball, or of what a ring is bent from
  Vec3 centre = Vec3::Zero();  ///< m; of a file, where its origin is
  double density = 1500;       ///< kg/m^3; a gallstone sinks in bile (d)
  double stiffness = 8e8;      ///< Pa, Young's modulus; 10 N across a stone of 10 mm strain it by 3e-4
  double ring = 0;             ///< m, radius of the circle in a ring's middle, about z; 0: it is no ring
  std::string path = {};       ///< of an OBJ file; empty: it is none of these
  double scale = 1;            ///< coordinates of the file times this are metres
  Vec3 turn = Vec3::Zero();    ///< rad: it is turned about this axis, through its centre, by the axis' length
  bool operator==(const RigidShape&) const = default;
};

/// A lobe of the liver, cut off at its back, where it is held. It lies as the gallbladder does that has its bed in the
/// lobe's underside: on the liver's side of the line from the organ's neck to its fundus.
struct LobeShape {
  double width = 140e-3, depth = 90e-3;    ///< m, across; from its back to its edge; the liver 280 by 160 (c)
  double thickness = 45e-3;                ///< m, about, at its back; the liver 80 mm (c)
  double edge = 9e-3;                      ///< m, thickness of its edge (d)
  double edge_angle = 0.6981317007977318;  ///< rad, between underside and upper side at its edge (d)
  double overhang = 16e-3;  ///< m, by which the fundus stands out beyond its edge; 10 to 15 mm (m)
  double bed_length = 80e-3, bed_width = 35e-3;  ///< m, of the gallbladder; a width of 0: there is no bed
  double bed_depth = 6.5e-3;                     ///< m, how deep the gallbladder lies in it (d)
  double young = 6e3;     ///< Pa; 2 to 6 kPa by elastography, 5 to 20 by indentation (c)
  double poisson = 0.45;  ///< nearly incompressible: beyond, its tetrahedra would lock (d)
  double density = 1060;  ///< kg/m^3; 1050 to 1060 (c)
  /// N/m of its capsule by stretch, once that is straight, and the stretch up to which it is slack: a capsule tears at a
  /// stretch of 1.47 (0.18 to 0.76 more than at rest) under 300 N/m (c: Brunon and others 2010; d between them).
  double capsule = 1.8e3, capsule_slack = 1.25;
  bool sags = false;  ///< false: as drawn it is in balance with its weight, as a liver seen in a patient is
  double hold = 1e7;  ///< N/m per m^2 of its back (d)
  bool operator==(const LobeShape&) const = default;
};

using OrganShape =
    std::variant<PearShape, SphereShape, SweptShape, MeshFile, TubeShape, RigidShape, LobeShape>;
/// Of its own kind, "pear", "sphere", "swept", "obj", "tube", "rigid", "lobe".
const std::string& shape_name(const OrganShape& shape);
/// The file that a shape is read from; null: none is.
const std::string* mesh_path(const OrganShape& shape);
const std::vector<std::string>& shape_names();
/// A closed shell with bile; else it has neither neck nor fundus, and no filling that is kept.
inline bool is_hollow(const OrganShape& shape) { return shape.index() <= 3; }
/// Soft inside under a thin capsule, which current takes off: a liver's lobe.
inline bool has_capsule(const OrganShape& shape) { return std::holds_alternative<LobeShape>(shape); }

/// Two families of fibres at `angle` to either side of the organ's axis (neck to fundus), tight only when
/// stretched, fading towards the poles: fem/shell.h, FibreLayout. The defaults are the human gallbladder's: E
/// is 641 kPa along the axis and 255 kPa around it (c: Karimi, Shojaei and Tehrani 2017,
/// doi 10.1080/03091902.2017.1366561). Each family adds 4 k1 along itself, so k1 = (641 - 255) / 8 kPa in a
/// wall of shear modulus 255 / 3 = 85 kPa.
struct FibreDefinition {
  double stiffness = 48e3;  ///< k1 of each family, Pa
  double stiffening = 1.0;  ///< k2, dimensionless; 0: does not stiffen (d)
  double angle = 0;         ///< rad from the axis, 0 to pi / 2: 0 longitudinal, pi / 2 circumferential
};

struct WallDefinition {
  double thickness = 2e-3;       ///< m; 2 to 3 mm (c)
  double shear_modulus = 100e3;  ///< Pa at rest; a third of E = 300 kPa, incompressible (c, spread tenfold)
  /// b of the exponential (Fung, Demiray) law, dimensionless; 0 is the neo-Hookean wall (d: no figure for the
  /// gallbladder is known to us).
  double stiffening = 0;
  std::optional<FibreDefinition> fibres;  ///< none: isotropic
  double overstretch = 2.2;               ///< principal stretch above which `overstretch` is raised (d)
  // What opens it, as the event `perforation`; holes are not cut.
  double perforation_stretch =
      3;                    ///< principal stretch: 0.9 MPa of the usual wall, which fails at 0.3 to 1.2 (d)
  double pinch_limit = 15;  ///< N, of a jaw on a fold; damage is seen at 15 to 37 by jaw (c)
  double burn_energy = 15;  ///< J of current in one place: a spot of 2 mm, 2 mm deep, boiled away (d)
  double density = 0;       ///< kg/m^3; soft tissue 1050 (c); 0: neither weight nor inertia, as in the paper
  double retardation = 5e-3;  ///< s; its stress is that at x + this dx/dt, where it moves (d, uncalibrated)
  double burn_reach =
      0.3e-3;  ///< m: current that flows nearer than this heats it (acts/burn.h; d, uncalibrated)
  double raw_energy =
      2.5e6;  ///< J/m^2 that takes its capsule off: 1 mm of water, boiled away (d, uncalibrated)
};

/// Give one of the two; with neither the organ is filled to its unstressed volume.
struct BileDefinition {
  double density = 1020;                ///< kg/m^3; 1010 to 1040 (c)
  std::optional<double> fill_volume;    ///< m^3
  std::optional<double> fill_pressure;  ///< Pa, gauge, at the highest point
};

/// An elastic foundation under the skin within `radius` of a place: the cystic plate, the duct's root.
struct HeldRegion {
  std::string name = "bed";
  std::string landmark;    ///< a landmark of the organ, see landmark_rows()
  double radius = 10e-3;   ///< m, geodesically coarse: straight distance at rest
  double stiffness = 3e5;  ///< N/m per m^2 of skin (d)
  /// Until the organ is filled; then what it is tied to holds it, such as tissue.
  bool while_filled = false;
};

/// What it is called to cut or close a tube near its start.
struct InjuryNearStart {
  double within = 0;  ///< m along the tube at rest, from its start
  std::string called;
};

/// What an injury is called where another organ has been cut or closed too, whichever was first.
struct InjuryTogether {
  std::string with;  ///< an organ
  std::string called;
};

/// What an instructor calls it when an organ that should be kept is hurt, such as "Strasberg E": the text of the event
/// `injury`. Empty: it is none.
struct InjuryDefinition {
  std::string cut;        ///< it is divided
  std::string closed;     ///< a clip shuts it
  std::string partly;     ///< a clip holds a part of its width, or current goes through its wall
  std::string unclipped;  ///< it is divided without a shut clip on the patient's side
  /// Of these places that which reaches least far stands for `cut` and `closed`.
  std::vector<InjuryNearStart> near_start = {};
  /// The first of these that holds stands for `cut`, `closed` and `unclipped`.
  std::vector<InjuryTogether> together = {};
};

/// A branch of an artery on a hollow organ's wall, which is drawn there and neither moves nor bleeds by itself.
struct WallVessel {
  std::vector<Vec3> points;  ///< m, at rest, on the skin or near it, from where the artery comes to the wall
  double radius = 0.5e-3;    ///< m, there; it tapers towards its end
};

/// How an organ is drawn: a hollow one full of bile, or pale, as one that mucus has filled (hydrops); a rigid thing as a
/// stone, or as plastic. `bile` is what each kind usually looks like.
enum class OrganLooks { bile, pale, plastic };
constexpr OrganLooks last_of(OrganLooks) { return OrganLooks::plastic; }

struct OrganDefinition {
  std::string name = "gallbladder";
  OrganShape shape = PearShape{};
  int nodes = 180;                      ///< control nodes; ignored for a mesh file
  Vec3 neck{-50e-3, 130e-3, -110e-3};   ///< m; lower pole of the shape (d)
  Vec3 fundus{-80e-3, 100e-3, -60e-3};  ///< m; the upper pole points this way (d)
  Vec3 liver_side{0.0, 0.8, 0.6};       ///< direction from the organ's axis to its bed; made orthogonal to it
  WallDefinition wall;
  BileDefinition bile;
  std::vector<HeldRegion> held;
  OrganLooks looks = OrganLooks::bile;
  bool extensions = true;     ///< false: none are laid on this organ, whatever the solver's levels
  std::string compared_with;  ///< another organ of the same shape and posture, see session/skin_difference.h
  InjuryDefinition injury;
  double keep_clear = 0;  ///< m: current nearer to it is the event `activation_beside`; 0: it may be (d)
  std::vector<WallVessel> vessels =
      {};  ///< from which its finer ones grow; none: from two places of its neck
};

/// What ties a place on one body to one on another, which follows it: where a duct grows out of an organ or enters
/// another duct, its end keeps its place and direction there.
struct JointDefinition {
  std::string from, to;    ///< "organ.landmark"
  double radius = 4e-3;    ///< m, of what of `to` the end holds on to, and of the end that is held
  double stiffness = 2e3;  ///< N/m, of all of it (d)
};

/// How a tissue's strands are drawn: as lobules of fat, or as the fibres of a loose (areolar) plane.
enum class TissueLooks { fat, areolar };
constexpr TissueLooks last_of(TissueLooks) { return TissueLooks::areolar; }

/// Connective tissue between two organs, which may be dissected: strands from the surface of one to the nearest place of
/// the other, slack until they are stretched, each standing for a part of the area. By area so that its number of strands
/// changes nothing but how finely it tears.
struct TissueDefinition {
  std::string name = "tissue";
  std::string from, to;        ///< organs
  double within = 5e-3;        ///< m: where their surfaces are nearer than this at rest
  double start = 0, stop = 1;  ///< of the way of `from`: a tube's length, else from neck to fundus
  int strands = 100;           ///< at most
  double slack = 0.1;          ///< by how much of its length at rest a strand is longer than that
  double stiffness = 10e3;     ///< Pa, tension by area and strain as they become taut (d)
  double stiffening = 1.5;     ///< exponent of tension a strain (d)
  double strength = 30e3;      ///< Pa, largest tension by area (d, uncalibrated)
  double break_energy = 150;   ///< J/m^2 to tear it: the force of a peel by width, N/m (d, uncalibrated)
  double density = 1000;       ///< kg/m^3
  double radius = 0.2e-3;      ///< m, of a strand as instruments feel it; 0: they do not (d, uncalibrated)
  /// J/m^2 of current's power that divides it: 1 mm of water, boiled away (d, uncalibrated).
  double divide_energy = 2.5e6;
  bool covered = false;  ///< by a leaf of peritoneum towards the front: how it looks, no more
  TissueLooks looks = TissueLooks::fat;
};

/// A leaf of peritoneum over two tubes and what is between them, towards the front, that goes with them: how it looks, no
/// more. It is gone where one of them is.
struct LeafDefinition {
  std::string from, to;
  double start = 0, stop = 1;  ///< of the length of `from`
  double free_edge = 2e-3;     ///< m, how far it goes on past `from` (d)
  double goes_on = 0;          ///< m, and past `to` (d)
};

enum class GroundType { plane, capsule, box };

/// How ground is drawn. Usual: beside a lobe of the liver as peritoneum, as planes always; else as the liver. Board and
/// plastic are what a training box has in it.
enum class GroundLooks { usual, liver, bowel, fat, peritoneum, board, plastic };

/// What stays, and is touched: the liver before there is one, a bone, a table.
struct GroundDefinition {
  std::string name = "ground";
  GroundType type = GroundType::plane;
  Vec3 point = Vec3::Zero();    ///< m, on the plane; a capsule's beginning; a box's centre
  Vec3 normal = Vec3::UnitZ();  ///< unit, of the plane, out of what is solid
  Vec3 to = Vec3::Zero();       ///< m, a capsule's end
  Vec3 size = Vec3::Zero();     ///< m, of a box along x, y and z, without its rounding
  double radius = 5e-3;         ///< m, of a capsule, and of a box' edges
  double friction = 0;          ///< Coulomb's, of what touches it (d); the rest state is found without
  GroundLooks looks = GroundLooks::usual;
  /// What the event `injury` calls it when it is hurt; empty: as its looks say, liver and bowel are hurt and nothing else.
  std::string injury = {};
  double thrust_limit = 8;  ///< N, from jaws or what a shaft ends in, that hurts it; uncalibrated
};

struct SupportDefinition {
  Vec3 point = Vec3::Zero();    ///< m
  Vec3 normal = Vec3::UnitZ();  ///< unit
  double friction = 0;          ///< Coulomb's, of the skin on it (d); the rest state is found without
};

/// Of a lobe's skin, on which its tetrahedra are condensed.
inline constexpr int lobe_nodes = 90;
/// Control nodes of all organs together: more take over half a minute to come to rest.
inline constexpr int most_nodes = 1000;
/// Of all tissues together: 600 take some 3 ms of an iteration.
inline constexpr int most_strands = 1500;
inline constexpr std::size_t most_organs = 24;
inline constexpr std::size_t most_instruments = 16;

struct AnatomyDefinition {
  std::vector<OrganDefinition> organs;
  std::vector<JointDefinition> joints;
  std::vector<TissueDefinition> tissue;
  std::vector<LeafDefinition> leaves;
  std::vector<GroundDefinition> ground;
  std::optional<SupportDefinition> support;
  double friction = 0;  ///< Coulomb's, of the organs on each other (d); the rest state is found without
  double rest_within =
      10e-3;               ///< m: organs that come to rest further from where they are drawn are named (d)
  double heart_rate = 70;  ///< a minute, with which what bleeds pulses; 60 to 80 at rest (c)
  double table_head_up = 0.2617993877991494;     ///< rad; reverse Trendelenburg 15 deg (c)
  double table_left_down = 0.17453292519943295;  ///< rad; left side down 10 deg (d)
};

/// Names and places of the ports (d), American and French: see default_ports().
struct PortDefinition {
  std::string name;
  Vec3 position = Vec3::Zero();  ///< m
};

/// What each is: instrument_rows() (anatomy/instruments.h).
enum class InstrumentType {
  atraumatic_grasper,
  bipolar_electrode,
  semm_forceps,  ///< Semm's endocoagulation forceps
  maryland_dissector,
  l_hook,
  scissors,
  clip_applier,
  aspiration_needle,
};

/// Of titanium clips, a row each in clip_rows() (anatomy/instruments.h).
enum class ClipSize { m, ml };
constexpr ClipSize last_of(ClipSize) { return ClipSize::ml; }

struct InstrumentDefinition {
  std::string name;  ///< "left", "right", ...
  InstrumentType type = InstrumentType::atraumatic_grasper;
  std::string port;
  double force_limit =
      8.0;  ///< N on the jaws, or on what the shaft ends in; above it `overforce` is raised (d)
  double pinch_force = 6.8;  ///< N, each jaw on the fold it holds: what surgeons apply (c)
  double pad_friction =
      0.8;  ///< Coulomb's, each serrated pad on the wall: 3 N of pinch hold a pull of 5 N (c)
  /// Coulomb's, of the wet skin on the shaft and on what of the jaws does not hold it; a smooth shaft has 0 to
  /// 0.3 (c).
  double friction = 0;
  double power = 30;  ///< W of its current, where it has any: 25 to 40 in use (c)
  ClipSize clip = ClipSize::ml;
  int clips = 8;  ///< that it carries at the start
  // Of a needle that draws liquid out, liquid/aspirate.h. A bore of 1.6 mm is 14 gauge (c); the others (d), uncalibrated.
  double bore = 1.6e-3;         ///< m, across
  double bore_length = 330e-3;  ///< m, from its mouth to where the suction's pressure is
  double suction = 13e3;        ///< Pa below the pressure outside: some 100 mmHg
  double pinhole = 0.3e-3;      ///< m, across what it leaves open of a wall that it was through; 0: sealed
  bool waits = false;           ///< outside at the start, while another one is in its port: for an exchange
  double hand_force =
      20;  ///< N at the tip: what its hand holds against; beyond, it gives way (d), uncalibrated
  double port_friction = 0.5;  ///< N along the shaft that slides through its port, at its hand: 0.25 to 3 (c)
};

inline constexpr int most_clips = 50;

/// What an instrument can be made to do beside moving and closing, for as long as a foot or a finger asks for it.
enum class InstrumentAction {
  none,
  activate,  ///< current flows
  fire,      ///< what it carries is set: a clip
  irrigate,
  aspirate,  ///< liquid is drawn out through a bore
  exchange,  ///< it comes in through its port for the one that is there
};
constexpr InstrumentAction last_of(InstrumentAction) { return InstrumentAction::exchange; }

/// In the order of the types.
const std::vector<std::string>& instrument_type_names();
std::string to_text(InstrumentType type);
std::optional<InstrumentType> instrument_type_called(const std::string& name);
bool has_jaws(InstrumentType type);

/// "none", "activate", "fire", "irrigate", "aspirate", "exchange", in the order of the actions.
const std::vector<std::string>& instrument_action_names();
std::string to_text(InstrumentAction action);
std::optional<InstrumentAction> instrument_action_called(const std::string& name);
/// Whether an instrument of this type knows the action; each knows none and exchange.
bool has_action(InstrumentType type, InstrumentAction action);
/// The one that its pedal or trigger asks for; none: it has neither.
InstrumentAction main_action(InstrumentType type);
/// An unnamed instrument with the defaults of its type. Pinch and friction mean nothing without jaws.
InstrumentDefinition default_instrument(InstrumentType type);

/// What it is called among instruments, by who moves them.
inline constexpr const char* laparoscope_name = "laparoscope";

/// How the picture's horizon is kept: the camera on the laparoscope is held level, whatever the shaft does, or it is fixed
/// to the shaft, and who moves it has to turn it so that the horizon is level.
enum class Horizon { level, held };
constexpr Horizon last_of(Horizon) { return Horizon::held; }

struct LaparoscopeDefinition {
  std::string port = "umbilical";
  double angle = 0.5235987755982988;           ///< rad; 0 or 30 deg (c)
  double field_of_view = 1.3089969389957472;   ///< rad, across the picture's round field; 70 to 80 deg (c)
  std::string look_at = "gallbladder.fundus";  ///< organ.landmark
  double distance = 90e-3;                     ///< m from the scope's tip to what it looks at
  double light = 1;     ///< brightness of its light, 1: what is looked at is well lit, at any distance
  double exposure = 1;  ///< of the camera; pictures go by light times exposure
  Horizon horizon = Horizon::level;
  bool show_structure = false;  ///< draw elements and nodes on the organs: a debug view
};

/// How the unknowns of structural extensions are solved for: with the coarse ones, onto which they are condensed, or
/// after them, as the paper does (section 5).
enum class ExtensionScheme { condensed, staged };

/// What a step is: a rest under its loads, or a time in which masses move (body/inertia.h).
enum class SolverMotion { statics, dynamics };

/// Nodes of the finest level of extensions of all organs together: each takes some 5 kB.
inline constexpr std::size_t most_finest_nodes = 64'000;
inline constexpr int most_extension_levels = 4;  ///< a 61-node ball's nodes then stand 0.6 mm apart

struct SolverDefinition {
  double rate = 50;  ///< steps a second
  SolverMotion motion = SolverMotion::statics;
  double tolerance = 1e-6;  ///< dimensionless, see group/equilibrium.h
  int extension_levels =
      0;  ///< of structural extensions at contacts, see motion/structural_extension.h; 0: none
  ExtensionScheme extension_scheme = ExtensionScheme::condensed;
  /// m; where the laparoscope looks at an organ from nearer than this, it has an extension there too; 0: never
  double extension_view = 0;
  /// Steps that are known to change nothing are not computed again; off only to measure what they cost.
  bool skip_still = true;
};

struct SceneDefinition {
  AnatomyDefinition anatomy;
  std::vector<PortDefinition> ports;  ///< empty: default_ports()
  std::vector<InstrumentDefinition> instruments;
  LaparoscopeDefinition laparoscope;
  SolverDefinition solver;
};

/// umbilical, epigastric, right_subcostal, right_lateral, left_upper, right_flank, subcostal (d).
std::vector<PortDefinition> default_ports();

/// A place on every organ of its kind: of hollow ones on the skin next to a point of the box around it, of tubes along
/// their middle; rigid things have their centre, rings also places on the circle in their middle, lobes places on their
/// skin.
struct Landmark {
  const char* name;
  const char* doc;
  double
      along;  ///< share of the way from the neck's end to the fundus' end, from start to end, from back to edge; of a ring
  ///< of the way round it from +x towards +y, as it was turned
  double
      side;  ///< across: -1 on the free side, 0 on the axis, 1 on the liver's side; of a lobe -1 below, 1 above
  enum class Of { hollow, tube, rigid, ring, lobe } of = Of::hollow;
};
const std::vector<Landmark>& landmark_rows();
bool has_landmark(const OrganShape& shape, const Landmark& landmark);
std::vector<std::string> landmarks_of(const OrganShape& shape);
/// Of all kinds.
std::vector<std::string> organ_landmarks();
/// Every "organ.landmark" of a scene.
std::vector<std::string> landmark_names(const std::vector<OrganDefinition>& organs);

/// The anatomies an author names: "standard" (a pear filled to 12 mmHg on its bed), "hydrops" (tense, 70 mL).
Result<AnatomyDefinition> named_anatomy(const std::string& name);
const std::vector<std::string>& anatomy_names();

/// All that is wrong with a scene at once, each with the path of its field (place.path, rooted at "scene"),
/// its value in SI with the unit, and a hint. Paths read as an author writes the scene: lists count from 1
/// ("scene.anatomy.organs[1].wall.thickness", "scene.anatomy.organs[1].held[2].landmark"), a shape's fields
/// are under ".shape", instruments and ports go by their names ("scene.instruments.left.port",
/// "scene.ports.umbilical") unless the name is itself the problem ("scene.instruments[2].name"). Empty when
/// the scene is sound.
std::vector<Problem> validate(const SceneDefinition& scene);
/// The same of an organ that comes later, with paths from "organ": ".wall.thickness" is "organ.wall.thickness".
std::vector<Problem> validate(const OrganDefinition& organ);
/// The same of a tissue that comes later, rooted at "tissue"; `organs`: the names of those that there are then.
std::vector<Problem> validate(const TissueDefinition& tissue, const std::vector<std::string>& organs);

}  // namespace calot
