/** Says that the world or a device of the cell is lost, and connects it again. */
import { IconPlugConnectedX } from '@tabler/icons-react'
import { useEffect, useState } from 'react'
import { connectCell, loadCellConnection, useCellConnection } from '../../api/cellConnection'
import { wordsOf } from '../../api/client'
import { useLive } from '../../api/live'
import { CommandButton } from '../../components/CommandButton'
import { Notice } from '../../components/Notice'

const LOOK_MS = 1000
const LOST: ReadonlySet<string> = new Set(['fault', 'disconnected'])

export function LostCell() {
  const { connected, reason } = useCellConnection()
  const isServed = useLive((s) => s.connection === 'live')
  const mayOperate = useLive((s) => s.role === 'operator')
  const modes = useLive((s) =>
    Object.values(s.robots)
      .map((robot) => robot.mode)
      .filter((mode) => LOST.has(mode))
      .join(),
  )
  const isSuspect = isServed && (modes !== '' || !connected)
  const { isConnecting, problem, connect } = useConnect()
  useEffect(() => {
    if (!isSuspect) return
    void loadCellConnection()
    const timer = setInterval(() => void loadCellConnection(), LOOK_MS)
    return () => clearInterval(timer)
  }, [isSuspect, modes])
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
            onPress={() => void connect()}
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

function useConnect() {
  const [isConnecting, setConnecting] = useState(false)
  const [problem, setProblem] = useState('')
  async function connect(): Promise<void> {
    setConnecting(true)
    setProblem('')
    try {
      await connectCell()
    } catch (error) {
      setProblem(wordsOf(error))
    } finally {
      setConnecting(false)
    }
  }
  return { isConnecting, problem, connect }
}
