"""Plots as small files: lines and text need few colours."""
from PIL import Image


def save(figure, file, **options):
    figure.savefig(file, **options)
    Image.open(file).convert("RGB").quantize(64).save(file, optimize=True)
