// The frame that the charts and the viewer of a run show together.

const kEvent = 'splitfusion-frame';

/** Tells all parts of a run which frame is shown. */
export function showFrame(run, frame, from) {
  document.dispatchEvent(
      new CustomEvent(kEvent, {detail: {run, frame, from}}));
}

/** Calls `shown` with the frame when another part of the run shows one. */
export function onFrame(run, self, shown) {
  document.addEventListener(kEvent, ({detail}) => {
    if (detail.run === run && detail.from !== self) shown(detail.frame);
  });
}
