"""Cistula: an exact ray tracer; the same image, bit for bit, from the CPU and from the GPU."""
