/** The 3D view of the cell: ours, but of an origin of its own, so that no picture of it holds up the page and its STOP. */
import { Box, useComputedColorScheme } from '@mantine/core'
import { IconCube } from '@tabler/icons-react'
import { useEffect, useRef } from 'react'
import { sendDragKeepAlive } from '../../api/handleDrag'
import { useLive } from '../../api/live'
import { usePast } from '../../api/past'
import { useSession } from '../../api/session'
import { PAGE } from '../../api/layerGroups'
import { stopByKey } from '../../components/stopKey'
import { Empty } from '../../components/Empty'
import { PastMark } from './PastMark'

export function CellFrame() {
  const scheme = useComputedColorScheme('light')
  const generation = useLive((s) => s.generation)
  const isPast = usePast((s) => s.shown !== null && !s.shown.problem)
  const port = useSession((s) => s.session?.cell_view_port)
  const origin = `http://${location.hostname}:${port}`
  const frame = useViewMessages(origin)
  if (typeof port !== 'number') {
    return (
      <Empty icon={<IconCube size={28} stroke={1.4} aria-hidden />} title="No 3D view">
        This server was started without one.
      </Empty>
    )
  }
  const query = scheme === 'dark' ? '?darkMode&hideViserLogo' : '?hideViserLogo'
  // A new generation is a restarted server: its viser has another key, so the frame is loaded anew.
  return (
    <Box pos="relative" w="100%" h="100%" bg="var(--canvas)" data-shows={isPast ? 'past' : 'present'}>
      {/* It has an origin of its own in the place of a sandbox; see decision 0029. With the scheme of its document, which
          names none, it lets the box through while that loads: a colour of its own would be that of the light theme. */}
      <Box
        component="iframe"
        display="block"
        w="100%"
        h="100%"
        bd={0}
        style={{ colorScheme: 'light' }}
        key={`${scheme}${generation}`}
        ref={frame}
        title="3D view of the cell"
        src={`${origin}/cell/${PAGE}/${query}`}
      />
      <PastMark />
    </Box>
  )
}

/** Hears from the view that the mouse is down in it, and of the key of STOP; returns the reference for its frame. */
function useViewMessages(origin: string) {
  const frame = useRef<HTMLIFrameElement>(null)
  useEffect(() => {
    const hear = (event: MessageEvent<{ cellView?: string } | null>) => {
      if (event.source !== frame.current?.contentWindow || event.origin !== origin) return
      if (event.data?.cellView === 'held') sendDragKeepAlive()
      if (event.data?.cellView === 'stop') stopByKey()
    }
    window.addEventListener('message', hear)
    return () => window.removeEventListener('message', hear)
  }, [origin])
  return frame
}
