/** What to do where there is nothing on the canvas yet. */
import { IconPlus } from '@tabler/icons-react'
import { Panel } from '@xyflow/react'
import { openAddPalette } from './paletteRequests'

export function EmptyCanvas() {
  return (
    <Panel position="top-center" className="beginning">
      <p>
        <strong>Nothing here yet.</strong> Drag a state from the library, or add one by its name.
      </p>
      <button type="button" className="command is-strong" onClick={() => openAddPalette()}>
        <IconPlus size={15} aria-hidden /> Add a state <kbd>A</kbd>
      </button>
    </Panel>
  )
}
