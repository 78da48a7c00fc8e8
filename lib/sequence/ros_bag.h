#ifndef SPLITFUSION_LIB_SEQUENCE_ROS_BAG_H_
#define SPLITFUSION_LIB_SEQUENCE_ROS_BAG_H_

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace splitfusion {

/// A file of ROS 1, `.bag` of version 2.0 without compression: which messages
/// it has, and where. Thread-safe.
class RosBag {
 public:
  /// One topic.
  struct Topic {
    std::string type;  ///< "sensor_msgs/Image".
    /// Of its messages, in the order of the file.
    std::vector<std::uint64_t> offsets;
    /// Their sizes.
    std::vector<std::uint32_t> bytes;
  };

  /// Goes through the records, without the messages themselves.
  ///
  /// @throw InputError if it is missing, truncated, no such file, or
  ///     compressed.
  explicit RosBag(const std::string& path);

  /// By name.
  const std::map<std::string, Topic>& topics() const { return topics_; }

  /// Bytes of the i-th message of a topic, `most` of them at most.
  ///
  /// @throw InputError if it cannot be read.
  std::string Message(const Topic& topic, int i,
                      std::uint32_t most = 0xffffffff) const;

  /// The file.
  const std::string& path() const { return path_; }

 private:
  class Records;
  /// Goes through what lies between two offsets: a chunk, or the file.
  void Scan(Records* records, std::uint64_t begin, std::uint64_t end,
            bool is_chunk);

  std::string path_;
  std::map<std::string, Topic> topics_;
  std::map<std::uint32_t, std::string> topic_of_;  // By connection.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_ROS_BAG_H_
