#include "splitfusion/lib/segmentation/detection_list.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <utility>

#include "splitfusion/lib/base/brief_json.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/json_file.h"
#include "splitfusion/lib/base/text_file.h"
#include "splitfusion/lib/segmentation/class_names.h"

namespace splitfusion {
namespace {

// Others keep the order of keys, under the name Json.
using PlainJson = nlohmann::json;

PlainJson ReadJson(const std::string& path) {
  const PlainJson json = ReadJsonOrNull<PlainJson>(path);
  if (!json.is_array()) {
    throw InputError(path +
                     ": no JSON list: expected [{\"index\": 1, "
                     "\"class\": \"person\", \"score\": 0.9}, ...]");
  }
  return json;
}

/// `path`: where the entry stands, for the message.
Detection ParseDetection(const std::string& path, const PlainJson& entry,
                         const std::string& unnamed_class) {
  Detection detection;
  try {
    detection.index = entry.at("index").get<int>();
    detection.class_name = entry.value("class", unnamed_class);
    detection.score = entry.value("score", 1.0);
    detection.mask = entry.value("mask", "");
    const auto corners = entry.value("box", std::vector<double>(4, 0.0));
    detection.box = {cv::Point2d(corners.at(0), corners.at(1)),
                     cv::Point2d(corners.at(2), corners.at(3))};
  } catch (const std::exception&) {
    detection.index = 0;
  }
  const bool ok = detection.index >= 1 && detection.index <= 65535 &&
                  detection.score >= 0 && detection.score <= 1;
  if (!ok) {
    throw InputError(path + ": detection " + BriefJson(entry) +
                     ": expected an index of 1..65535, a class name, a score "
                     "of 0..1 and, if any, the 4 corners of a box");
  }
  return detection;
}

/// @throw InputError if the index of the last detection has come before; the
/// pixels of a label image can belong to one only. `path`: for the message.
void CheckNewIndex(const std::string& path,
                   const std::vector<Detection>& detections) {
  const int index = detections.back().index;
  const auto same = [index](const Detection& d) { return d.index == index; };
  if (std::none_of(detections.begin(), detections.end() - 1, same)) return;
  throw InputError(path + ": index " + std::to_string(index) + " ('" +
                   detections.back().class_name +
                   "') a second time: expected each index of a frame once");
}

/// A name as it is; that of a COCO number; empty if there is none.
std::string NameOfClass(const std::string& word) {
  if (word.find_first_not_of("0123456789") != std::string::npos) return word;
  const std::vector<std::string>& names = CocoClassNames();
  const std::size_t number =
      word.empty() || word.size() > 2 ? 0 : std::stoul(word);
  return number >= 1 && number <= names.size() ? names[number - 1] : "";
}

/// To a tenth of a pixel, so that sums of corners and sizes stay short.
double Tenths(double value) { return std::round(value * 10) / 10; }

}  // namespace

std::vector<Detection> ReadDetections(const std::string& path,
                                      const std::string& unnamed_class) {
  std::vector<Detection> detections;
  for (const PlainJson& entry : ReadJson(path)) {
    detections.push_back(ParseDetection(path, entry, unnamed_class));
    CheckNewIndex(path, detections);
  }
  return detections;
}

std::vector<Detection> ReadClassList(const std::string& path) {
  std::vector<Detection> detections;
  for (const TextLine& line : ReadTextLines(path, /*cut_comments=*/true)) {
    std::istringstream words(line.text);
    Detection detection;
    words >> detection.index >> std::ws;
    std::getline(words, detection.class_name);
    detection.class_name = NameOfClass(detection.class_name);
    if (detection.index < 1 || detection.index > 65535 ||
        detection.class_name.empty()) {
      line.Refuse(
          "an index of 1..65535 and a class, by its name or its COCO number of "
          "1..80");
    }
    detections.push_back(std::move(detection));
    CheckNewIndex(line.place, detections);
  }
  return detections;
}

DetectionLists ReadDetectionLists(const std::string& path,
                                  const std::string& unnamed_class) {
  std::ifstream stream(path);
  if (!stream) throw InputError(path + ": cannot be opened");
  DetectionLists lists;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    const std::string place = path + ":" + std::to_string(number);
    const PlainJson entry =
        PlainJson::parse(line, nullptr, /*allow_exceptions=*/false);
    const bool has_stem = entry.is_object() && entry.contains("stem") &&
                          entry["stem"].is_string();
    if (!has_stem) {
      throw InputError(place +
                       ": expected an object with stem, index, class and "
                       "score of one detection");
    }
    std::vector<Detection>& list = lists[entry["stem"]];
    list.push_back(ParseDetection(place, entry, unnamed_class));
    CheckNewIndex(place, list);
  }
  return lists;
}

std::string DetectionLine(int frame, const std::string& stem,
                          const Detection& detection) {
  const cv::Rect2d& box = detection.box;
  nlohmann::ordered_json line = {
      {"frame", frame},
      {"stem", stem},
      {"index", detection.index},
      {"class", detection.class_name},
      {"score", detection.score},
      {"box",
       {Tenths(box.x), Tenths(box.y), Tenths(box.x + box.width),
        Tenths(box.y + box.height)}}};
  if (!detection.mask.empty()) line["mask"] = detection.mask;
  return line.dump();
}

}  // namespace splitfusion
