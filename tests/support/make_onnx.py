#!/usr/bin/python3
"""make_onnx.py KIND FILE: a tiny ONNX network with the outputs of a real one.

The prototypes are computed from the image: prototype 0 is 20 (red - blue) of
4x4 blocks, prototype 1 its negative, so that masks follow what is painted.
Boxes, classes and coefficients are constants. KIND is yolact or yolov8seg, or
one of the faulty ones below.
"""
import sys

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper


def tensor(name, values, dtype=np.float32):
    return numpy_helper.from_array(np.asarray(values, dtype), name)


class Graph:
    """Nodes, weights and outputs of a network with one image as input."""

    def __init__(self, shape, dtype=np.float32):
        self.shape, self.dtype = shape, dtype
        self.nodes, self.weights, self.outputs, self.inputs = [], [], [], []
        self.inputs.append(
            helper.make_tensor_value_info("images", TensorProto.FLOAT, shape))

    def add(self, kind, inputs, output, **attributes):
        self.nodes.append(
            helper.make_node(kind, inputs, [output], **attributes))

    def weight(self, name, values, dtype=None):
        self.weights.append(tensor(name, values, dtype or self.dtype))
        return name

    def output(self, name, shape):
        self.outputs.append(
            helper.make_tensor_value_info(name, TensorProto.FLOAT, shape))

    def constant(self, name, values):
        """An output whose values do not depend on the image."""
        values = np.asarray(values, np.float32)
        if "mean" not in [n.output[0] for n in self.nodes]:
            self.add("GlobalAveragePool", ["images"], "pooled")
            self.add("Flatten", ["pooled"], "mean")
        self.weight(name + "_w", np.zeros((values.size, 3)))
        self.weight(name + "_b", values.reshape(-1))
        self.add("Gemm", ["mean", name + "_w", name + "_b"], name + "_flat",
                 transB=1)
        self.weight(name + "_shape", values.shape, np.int64)
        self.add("Reshape", [name + "_flat", name + "_shape"], name)
        self.output(name, values.shape)

    def prototypes(self, name):
        kernel = np.zeros((2, 3, 4, 4))
        for p, sign in enumerate((1, -1)):
            kernel[p, 0] = sign * 20.0 / 16
            kernel[p, 2] = -sign * 20.0 / 16
        self.weight(name + "_k", kernel)
        self.add("Conv", ["images", name + "_k"], name,
                 kernel_shape=[4, 4], strides=[4, 4])

    def save(self, path):
        graph = helper.make_graph(self.nodes, "tiny", self.inputs,
                                  self.outputs, self.weights)
        model = helper.make_model(
            graph, opset_imports=[helper.make_opsetid("", 13)])
        model.ir_version = 7
        onnx.checker.check_model(model)
        onnx.save(model, path)


def yolov8seg(output0="output0", shape=(1, 3, 64, 96), dtype=np.float32):
    """Two classes and four anchors; boxes in pixels of 96x64."""
    graph = Graph(shape, dtype)
    anchors = [
        # cx, cy, w, h, class 0, class 1, coefficients
        [36, 32, 72, 64, 0.9, 0.1, 1, 0],
        [38, 32, 72, 64, 0.8, 0.1, 1, 0],  # Double of the first.
        [48, 32, 96, 64, 0.2, 0.6, 0, 1],
        [48, 32, 96, 64, 0.1, 0.05, 1, 1],
    ]
    graph.constant(output0, np.asarray(anchors).T[None])
    graph.prototypes("output1")
    graph.output("output1", (1, 2, 16, 24))
    return graph


def yolact():
    """Two classes; 258 priors of an input of 64x64, of which two detect."""
    graph = Graph((1, 3, 64, 64))
    loc, mask = np.zeros((1, 258, 4)), np.zeros((1, 258, 2))
    conf = np.tile([1.0, 0, 0], (1, 258, 1))
    conf[0, 252], mask[0, 252] = [0.1, 0.9, 0], [1, 0]
    conf[0, 255], mask[0, 255] = [0.3, 0.1, 0.6], [0, 1]
    loc[0, 252] = loc[0, 255] = [0, 0, 10, 10]  # Far beyond the image.
    graph.constant("loc", loc)
    graph.constant("conf", conf)
    graph.constant("mask", mask)
    graph.prototypes("proto_planes")
    graph.add("Transpose", ["proto_planes"], "proto", perm=[0, 2, 3, 1])
    graph.output("proto", (1, 16, 16, 2))
    return graph


def xfeat():
    """Key points are bright pixels, descriptors the pixels of a cell."""
    graph = Graph((1, 1, 64, 96))
    pixels = np.eye(64).reshape(64, 1, 8, 8)
    logits = np.concatenate([20 * pixels, np.zeros((1, 1, 8, 8))])
    graph.weight("logits_k", logits)
    graph.weight("logits_b", np.concatenate([np.zeros(64), [30]]))
    graph.weight("pixels_k", pixels)
    graph.add("Conv", ["images", "logits_k", "logits_b"], "keypoint_logits",
              kernel_shape=[8, 8], strides=[8, 8])
    graph.add("Conv", ["images", "pixels_k"], "descriptors",
              kernel_shape=[8, 8], strides=[8, 8])
    graph.output("keypoint_logits", (1, 65, 8, 12))
    graph.output("descriptors", (1, 64, 8, 12))
    return graph


def half():
    graph = yolov8seg()
    graph.weight("half_weight", [1.0], np.float16)
    return graph


def clip():
    """Clip whose limits are inputs of the node, computed ones."""
    graph = Graph((1, 3, 64, 96))
    graph.add("ReduceMin", ["images"], "low", keepdims=0)
    graph.add("ReduceMax", ["images"], "high", keepdims=0)
    graph.add("Clip", ["images", "low", "high"], "output0")
    graph.output("output0", (1, 3, 64, 96))
    return graph


def two_inputs():
    graph = yolov8seg()
    graph.inputs.append(
        helper.make_tensor_value_info("more", TensorProto.FLOAT, (1, 4)))
    return graph


KINDS = {
    "yolov8seg": yolov8seg,
    "yolact": yolact,
    "open_size": lambda: yolov8seg(shape=(1, 3, "height", "width")),
    "xfeat": xfeat,
    "other_names": lambda: yolov8seg(output0="boxes"),
    "gray": lambda: Graph((1, 1, 64, 96)),
    "half": half,
    "clip": clip,
    "two_inputs": two_inputs,
}

if __name__ == "__main__":
    made = KINDS[sys.argv[1]]()
    if not made.outputs:
        made.add("Identity", ["images"], "output0")
        made.output("output0", made.shape)
    made.save(sys.argv[2])
