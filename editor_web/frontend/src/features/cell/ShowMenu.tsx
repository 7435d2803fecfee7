/** What the 3D view of this page shows. */
import { Button, Checkbox, Popover, Stack } from '@mantine/core'
import { IconEye } from '@tabler/icons-react'
import { useState } from 'react'
import { LAYER_GROUPS, setLayerShown, useShownLayers, type LayerGroup } from '../../api/layerGroups'

const WORDS: Record<LayerGroup, readonly [label: string, description: string]> = {
  voxels: ['Voxels', 'Where the cameras see something unknown'],
  paths: ['Planned paths', 'Blue: proposed, green: active, red: blocked'],
  obstacles: ['Planning scene', 'Obstacles of the planning scene, and held parts'],
  people: ['People', 'Their arms in a simulated cell'],
  cameras: ['Cameras', 'Their poses and depth images'],
  detections: ['Detections', 'Boxes around detections, with label and score'],
  commanded: ['Commanded arms', 'Where real arms are told to be; without this, from 3° off on'],
  frames: ['Frames', 'Axes of the world, the tools and the parts'],
}

export function ShowMenu() {
  const [isOpen, setOpen] = useState(false)
  const shown = useShownLayers((s) => s.groups)
  return (
    <Popover opened={isOpen} onChange={setOpen} position="bottom-end" width={290} shadow="md" trapFocus returnFocus>
      <Popover.Target>
        <Button
          variant="default"
          size="compact-sm"
          title="Layers of the 3D view"
          leftSection={<IconEye size={15} aria-hidden />}
          onClick={() => setOpen(!isOpen)}
        >
          Show
        </Button>
      </Popover.Target>
      <Popover.Dropdown>
        <Stack gap="xs">
          {LAYER_GROUPS.map((group) => (
            <Checkbox
              key={group}
              size="sm"
              label={WORDS[group][0]}
              description={WORDS[group][1]}
              checked={shown.includes(group)}
              onChange={(event) => setLayerShown(group, event.currentTarget.checked)}
            />
          ))}
        </Stack>
      </Popover.Dropdown>
    </Popover>
  )
}
