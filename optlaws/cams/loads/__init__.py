"""Loads of cams: process forces on their followers, contact forces and torques, and springs that keep them on."""
