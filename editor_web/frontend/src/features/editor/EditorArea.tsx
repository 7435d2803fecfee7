/** The area of the editor, which says that it is busy, and tells others what is selected: its content is not drawn anew for that. */
import { Flex } from '@mantine/core'
import { useEffect, type ReactNode, type RefObject } from 'react'
import { showPresence } from '../../api/presence'
import { useEditor } from './store'

export function EditorArea({ area, children }: { area: RefObject<HTMLDivElement | null>; children: ReactNode }) {
  const isBusy = useEditor((s) => s.isBusy)
  const selected = useEditor((s) => s.selection.at(-1) ?? '')
  useEffect(() => showPresence({ node: selected }), [selected])
  return (
    <Flex direction="column" pos="relative" flex={1} mih={0} ref={area} data-editor aria-busy={isBusy}>
      {children}
    </Flex>
  )
}
