"""The terminal guide to the configuration of an equipment server: `flexcell equipment guide`."""

from robots.drivers.equipment.guide.equipment_guide import EquipmentGuide, guide_equipment

__all__ = ["EquipmentGuide", "guide_equipment"]
