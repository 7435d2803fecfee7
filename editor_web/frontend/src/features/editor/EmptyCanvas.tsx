/** What to do where there is nothing on the canvas yet. */
import { Button, Kbd, Paper, Text } from '@mantine/core'
import { IconPlus } from '@tabler/icons-react'
import { Panel } from '@xyflow/react'
import { openAddPalette } from './paletteRequests'

export function EmptyCanvas() {
  return (
    <Panel position="top-center">
      <Paper withBorder radius="md" mt="xl" px="md" py="sm" ta="center" fz="sm">
        <Text inherit mb="xs">
          <strong>Nothing here yet.</strong> Drag a state from the library, or add one by its name.
        </Text>
        <Button
          size="compact-sm"
          variant="light"
          leftSection={<IconPlus size={15} aria-hidden />}
          rightSection={<Kbd size="xs">A</Kbd>}
          onClick={() => openAddPalette()}
        >
          Add a state
        </Button>
      </Paper>
    </Panel>
  )
}
