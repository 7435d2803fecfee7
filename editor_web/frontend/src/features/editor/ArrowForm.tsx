/** The form of a chosen arrow: from where, with which outcome, to where. */
import { Button, Group } from '@mantine/core'
import { IconArrowRight, IconPlus, IconTrash } from '@tabler/icons-react'
import { edgeOf, NO_EDGE, type EdgeId } from '../../document/edgeId'
import { nodeOf } from '../../document/editing/model'
import { choose, remove } from './actions'
import { FormHead, LinkButton } from './FormParts'
import { openPortPalette, openInsertPalette } from './paletteRequests'
import { rootOf, useEditor } from './store'

export function ArrowForm({ arrow }: { arrow: EdgeId }) {
  const { machine, source, outcome } = edgeOf(arrow) ?? NO_EDGE
  const target = useEditor((s) => nodeOf(rootOf(s), machine)?.transitions.find((t) => t.source === source && t.outcome === outcome)?.target)
  return (
    <div data-form>
      <FormHead icon={<IconArrowRight size={18} aria-hidden />} title={outcome}>
        <LinkButton onPress={() => choose([`${machine}/${source}`])}>{source}</LinkButton> leads to {target ?? 'nothing'}
      </FormHead>
      <Group gap={6} p="sm">
        <Button
          size="compact-sm"
          variant="default"
          leftSection={<IconArrowRight size={15} aria-hidden />}
          onClick={() => openPortPalette(`${machine}/${source}`, outcome)}
        >
          Lead elsewhere
        </Button>
        <Button
          size="compact-sm"
          variant="default"
          leftSection={<IconPlus size={15} aria-hidden />}
          onClick={() => openInsertPalette(arrow)}
        >
          Insert a state
        </Button>
        <Button size="compact-sm" variant="default" leftSection={<IconTrash size={15} aria-hidden />} onClick={() => void remove()}>
          Disconnect
        </Button>
      </Group>
    </div>
  )
}
