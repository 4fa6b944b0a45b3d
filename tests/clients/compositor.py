"""Blender's compositor on one multi-layer frame: nodes that add up layers, multiply them and matte, whose results come back as arrays."""
import pathlib

import bpy

import clients


class Compositor:
    def __init__(self, frame, out, parts=None):
        """FRAME: the EXR. What Blender makes is written under OUT. PARTS: Blender opens this file, which has the same layers in parts."""
        frame, self.out = pathlib.Path(frame).resolve(), pathlib.Path(out).resolve()
        self.header, self.channels = clients.read(frame)
        height, width = self.channels["R"].shape
        self.scene = bpy.context.scene
        self.scene.render.resolution_x, self.scene.render.resolution_y, self.scene.render.resolution_percentage = width, height, 100
        self.scene.render.compositor_device = "CPU"
        self.scene.use_nodes = True
        self.nodes, self.links = self.scene.node_tree.nodes, self.scene.node_tree.links
        self.nodes.clear()
        self.image = bpy.data.images.load(str(pathlib.Path(parts).resolve() if parts else frame))
        source = self.nodes.new("CompositorNodeImage")
        source.image = self.image
        self.passes = {socket.name: socket for socket in source.outputs if socket.enabled}
        self.lights = [name for name in self.passes if name.startswith("Combined_")]
        self.results = self.nodes.new("CompositorNodeOutputFile")
        self.results.base_path = str(self.out)
        self.results.format.file_format = "OPEN_EXR"
        self.results.format.color_mode = "RGB"
        self.results.format.color_depth = "32"
        self.results.file_slots.clear()
        self.made = []

    def write(self, name, socket):
        self.results.file_slots.new(name + "_")
        self.links.new(socket, self.results.inputs[-1])
        self.made.append(name)

    def mix(self, mode, first, second):
        node = self.nodes.new("CompositorNodeMixRGB")
        node.blend_type = mode
        for socket, value in zip(node.inputs[1:], (first, second)):
            if isinstance(value, float):
                socket.default_value = (value, value, value, 1)
            else:
                self.links.new(value, socket)
        return node.outputs[0]

    def add_up(self, sockets):
        whole = sockets[0]
        for socket in sockets[1:]:
            whole = self.mix("ADD", whole, socket)
        return whole

    def regraded(self, group, factor):
        """All light groups added up, one of them times a factor."""
        return self.add_up([self.mix("MULTIPLY", self.passes[name], factor) if name == f"Combined_{group}" else self.passes[name] for name in self.lights])

    def matte(self, kind, name):
        node = self.nodes.new("CompositorNodeCryptomatteV2")
        node.source = "IMAGE"
        node.image = self.image
        node.layer_name = kind
        node.matte_id = name
        return node.outputs["Matte"]

    def render(self):
        """Arrays of all that was written."""
        bpy.ops.render.render()
        return {name: clients.layer(clients.read(self.path(name))[1], "") for name in self.made}

    def path(self, name):
        return self.out / f"{name}_{self.scene.frame_current:04}.exr"
