/** Says that the world or a device of the cell is lost, and connects it again. */
import { IconPlugConnectedX } from '@tabler/icons-react'
import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query'
import { cellConnectionQuery, connectCell, CONNECTED } from '../../api/cellConnection'
import { useLive } from '../../api/live'
import { problemOf, useOutdated } from '../../api/queryClient'
import { queryKeys } from '../../api/queryKeys'
import type { CellConnection } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import { Notice } from '../../components/Notice'

const LOOK_MS = 1000
const LOST: ReadonlySet<string> = new Set(['fault', 'disconnected'])

export function LostCell() {
  const isServed = useLive((s) => s.connection === 'live')
  const mayOperate = useLive((s) => s.role === 'operator')
  const modes = useLive((s) =>
    Object.values(s.robots)
      .map((robot) => robot.mode)
      .filter((mode) => LOST.has(mode))
      .join(),
  )
  const { connected, reason } = useConnection(isServed, modes)
  const client = useQueryClient()
  const connecting = useMutation({
    mutationFn: connectCell,
    onSuccess: () => client.refetchQueries({ queryKey: queryKeys.cellConnection }),
  })
  const { isPending: isConnecting } = connecting
  const problem = problemOf(connecting.error)
  if (connected || !isServed) return null
  return (
    <Notice
      role="alert"
      icon={<IconPlugConnectedX size={20} aria-hidden />}
      tools={
        mayOperate && (
          <CommandButton
            label={isConnecting ? 'Connecting' : 'Connect again'}
            tone="strong"
            obstacle={isConnecting ? 'it is being connected' : undefined}
            onPress={() => connecting.mutate()}
          />
        )
      }
    >
      <strong>The cell is not connected:</strong> {reason || 'no reason was given'}. Runs that need it are refused until it is connected
      again.
      {problem && (
        <>
          <br />
          <strong>Not connected:</strong> {problem}
        </>
      )}
    </Notice>
  )
}

/** What the server last said; it is asked as long as a robot is not well, or the cell was lost when it was asked last. */
function useConnection(isServed: boolean, modes: string): CellConnection {
  const isLost = (known: CellConnection | undefined) => isServed && (modes !== '' || known?.connected === false)
  useOutdated(queryKeys.cellConnection, modes)
  const { data = CONNECTED } = useQuery({
    ...cellConnectionQuery(),
    enabled: ({ state }) => isLost(state.data),
    refetchInterval: ({ state }) => (isLost(state.data) ? LOOK_MS : false),
  })
  return data
}
