#pragma once
// OpenIGTLink, as trackers and robots in research speak it, as events of a live session. Messages are read as the public
// protocol lays them out (versions 1 to 3); https://openigtlink.org.
//
//   TRANSFORM, POSITION, TDATA   where a tool is, mm: its device name (TDATA: its own) is the registration's `source`
//   SENSOR of one value          how far its jaws are open; device: the registration's `jaw`, else SOURCE/jaw
//   STRING                       device SOURCE/action: an action (`activate`), or `none`, until the next;
//                                device `session`: a command (`pause`, `resume`, `restart`, `abandon`, `end`), or an act
//                                with what is said (`time_out landmarks named`, `bail_out subtotal`)
//
// What else is sent (STATUS, requests, images) is left out, and said once for each kind and device.

#include <memory>
#include <set>
#include <string>

#include "input/live_decoder.h"
#include "input/registered_tool.h"

namespace calot {

class IgtlMessages : public LiveDecoder {
 public:
  /// Of a registration that live_problems_with() finds nothing wrong with. `source` is what messages call the sender.
  IgtlMessages(std::vector<LiveInstrument> instruments, std::shared_ptr<const Registration> registration,
               std::string source);
  void add(std::string_view bytes, std::vector<LiveEvent>& events) override;
  void finish(std::vector<LiveEvent>& events) override;
  bool ended() const override { return ended_; }
  /// A header that is none: where the next message begins is not known.
  bool broken() const override { return broken_; }

 private:
  /// What is known of a tool.
  struct Tool {
    const ForeignInstrument* foreign;
    int instrument;
    std::string jaw_device, action_device;
    RegisteredTool registered;
    std::optional<ForeignSample> last;
    std::optional<double> jaw;
    InstrumentAction action = InstrumentAction::none;
    bool said_held = false;
  };
  struct Header {
    int version = 0;
    std::string type, device;
    std::uint64_t body = 0, checksum = 0;
  };

  void read_header(std::vector<LiveEvent>& events);
  void read_message(std::vector<LiveEvent>& events);
  void read_content(std::string_view content, std::vector<LiveEvent>& events);
  void read_frame(const std::string& name, std::string_view numbers, std::vector<LiveEvent>& events);
  void read_position(std::string_view content, std::vector<LiveEvent>& events);
  void read_tracking(std::string_view content, std::vector<LiveEvent>& events);
  void read_sensor(std::string_view content, std::vector<LiveEvent>& events);
  void read_string(std::string_view content, std::vector<LiveEvent>& events);
  void read_command(const std::string& text, std::vector<LiveEvent>& events);
  void place(Tool& tool, const Mat3& axes, const Vec3& origin, std::vector<LiveEvent>& events);
  void send(Tool& tool, std::vector<LiveEvent>& events);
  Tool* tool_called(const std::string& source);
  void refuse(const std::string& message, const std::string& hint, std::vector<LiveEvent>& events) const;
  /// Of a kind of message or a device that is not used.
  void leave_out(const std::string& what, const std::string& hint, std::vector<LiveEvent>& events);

  std::vector<LiveInstrument> instruments_;
  std::shared_ptr<const Registration> registration_;
  std::string source_;
  std::vector<Tool> tools_;
  Header header_;
  bool in_body_ = false, ended_ = false, broken_ = false;
  std::string bytes_;       ///< of the header, or of a body that is kept
  std::uint64_t left_ = 0;  ///< bytes of the body that are still to come
  int number_ = 0;          ///< of the message
  std::set<std::string> left_out_;
};

}  // namespace calot
