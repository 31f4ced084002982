#pragma once
// The critical view of safety, measured: what a surgeon must see before anything is clipped (Strasberg), judged by its
// three criteria with 0 to 2 points each (Sanford and Strasberg). From which share on there are points is uncalibrated.

#include <optional>
#include <string>

#include "geometry/types.h"

namespace calot {

class Sight;

struct Field;

struct CriticalViewQuestion {
  std::string gallbladder = "gallbladder", liver = "liver", plate = "cystic_plate";  ///< names
  /// Landmarks, the corners of the hepatocystic triangle: between cystic duct, common hepatic duct and liver.
  std::string neck = "cystic_duct.start", junction = "cystic_duct.end", hilum = "common_duct.start";
  /// m, of a lens on the other side. Without it, square to the triangle, 25 mm behind it, and the liver hides nothing:
  /// for that look the pouch is turned over, off the liver.
  std::optional<Vec3> behind;
  double lower_part = 1.0 / 3;  ///< of the gallbladder's way from neck to fundus that has to be off the plate
  double near = 5e-3;           ///< m off the gallbladder in which a structure has to be free around
  double one_from = 0.6, two_from = 0.9;  ///< shares that earn one point, and two
};

struct CriticalView {
  /// The triangle from one side, by rays through it.
  struct Side {
    double open = 0;  ///< share of the rays that neither organs nor instruments stop before the triangle
    double cleared =
        0;  ///< share of those that meet no tissue before the next organ; 0 where next to none is open
  };
  Side front, back;
  double plate = 0;  ///< share of the plate's strands on the lower part that are torn; 1 where there are none
  int structures = 0;  ///< tubes that still enter the gallbladder
  int free =
      0;  ///< of those what is seen, from either side, and has no tissue on it but the plate's upper part
  int triangle_points = 0, plate_points = 0, structure_points = 0;  ///< 0 to 2 each
  int points() const { return triangle_points + plate_points + structure_points; }
};

/// The hepatocystic triangle's corners, m.
struct HepatocysticTriangle {
  Vec3 neck, junction, hilum;
};

/// `front`: from the laparoscope's lens. Points: for the triangle by the side that is cleared less, for the plate by its share,
/// for structures two where there are two and both are free, one where one of the two is.
CriticalView critical_view(const Field& field, const HepatocysticTriangle& triangle, const Sight& front,
                           const CriticalViewQuestion& question);

}  // namespace calot
