// Reconstructs a sequence in TUM layout with the library: frames in, camera
// trajectory, meshes and an account of every frame out.
//
//   01_reconstruct_sequence [SEQUENCE [OUTPUT]]
//
// Without arguments it makes a small synthetic sequence first. What sf_run adds
// to this are flags, pictures and the run directory.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/report/run_paths.h"
#include "splitfusion/lib/segmentation/mask_folder_segmenter.h"
#include "splitfusion/lib/sequence/image_folder_reader.h"
#include "splitfusion/lib/synthetic/synthetic_writer.h"
#include "splitfusion/pipelines/split_fusion.h"

namespace {

/// A room with a walking person, 12 frames, in `folder`.
void MakeSequence(const std::string& folder) {
  splitfusion::SyntheticOptions options;
  options.width = 320;
  options.height = 240;
  options.frames = 12;
  splitfusion::SyntheticWriterOptions writer_options;
  writer_options.overwrite = true;
  splitfusion::WriteSyntheticSequence(options, writer_options, folder);
}

void Print(const splitfusion::FrameReport& report) {
  std::printf("frame %2d  %.2f s ", report.frame, report.total_seconds);
  for (const splitfusion::SurfaceReport& surface : report.surfaces) {
    std::printf(" | %s: %s, %d nodes, %.1f mm", surface.label.c_str(),
                ToString(surface.state).c_str(), surface.nodes,
                1000 * surface.residual_rms);
  }
  std::printf("\n");
}

void Reconstruct(const std::string& sequence, const std::string& output) {
  splitfusion::ImageFolderReader reader(sequence);
  const std::string masks = splitfusion::FindMaskFolder(sequence);
  std::shared_ptr<splitfusion::Segmenter> segmenter;
  if (!masks.empty()) {
    segmenter = std::make_shared<splitfusion::MaskFolderSegmenter>(masks);
  }
  splitfusion::SplitFusion fusion(reader.camera(),
                                  splitfusion::PipelineOptions(),
                                  splitfusion::LabelTable(), segmenter);
  fusion.set_color_camera(reader.calibration().color);
  while (const auto frame = reader.Next()) Print(fusion.ProcessFrame(*frame));
  fusion.Finish();
  splitfusion::WriteTumTrajectory(output + "/trajectory.txt",
                                  fusion.trajectory());
  for (const auto& [id, surface] : fusion.surfaces()) {
    const std::string path =
        output + "/" +
        splitfusion::RunPaths::SurfaceName(id, surface->label()) + ".ply";
    splitfusion::WritePly(path, surface->mesh());
    std::printf("%s: %zu vertices\n", path.c_str(),
                surface->mesh().vertices.size());
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string folder =
      (std::filesystem::temp_directory_path() / "splitfusion_example").string();
  const std::string sequence = argc > 1 ? argv[1] : folder + "/sequence";
  const std::string output = argc > 2 ? argv[2] : folder + "/output";
  try {
    if (argc < 2) MakeSequence(sequence);
    Reconstruct(sequence, output);
  } catch (const splitfusion::InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
